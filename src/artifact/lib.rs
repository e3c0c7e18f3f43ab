//! What a file shows: values with styles as the layers of a sheet, facades as elevations, and the
//! measures of every value. How a sheet or a model becomes bytes is known in `fabricate`; how an
//! artifact gets its values, in `stage`.

mod elevation;
mod fault;
mod ground;
mod measure;
mod page;
mod paper;
mod ready;
mod report;
mod sheet;
mod style;
mod united;
mod within;

pub use fault::Fault;
pub use ground::{ReadyGround, ready_ground, table_value};
pub use measure::{measure, measure_drawn, values_at};
pub use page::{MapPlane, Page, SLACK};
pub use report::report;
pub use sheet::{Part, ReadySheet, finished, ready_sheet};
pub use within::within;
