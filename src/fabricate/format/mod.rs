//! Sheets and models as the bytes of files, a file per format.

pub mod dxf;
pub mod dxf_color;
pub mod geojson;
pub mod glb;
mod path_data;
pub mod stl;
pub mod svg;
pub mod threemf;
mod xml;
pub(crate) mod zip;

#[cfg(test)]
pub(crate) use xml::escaped;

/// What a unit of a drawing's coordinates is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileUnit {
    /// On the object, or on paper.
    Millimetre,
    /// On the ground, as the others.
    Centimetre,
    /// 25.4 mm.
    Inch,
    /// SVG has no name for it.
    Metre,
}

impl FileUnit {
    /// Its number among the units of DXF.
    fn dxf(self) -> &'static str {
        match self {
            FileUnit::Inch => "1",
            FileUnit::Millimetre => "4",
            FileUnit::Centimetre => "5",
            FileUnit::Metre => "6",
        }
    }

    /// Its name in SVG.
    fn svg(self) -> &'static str {
        match self {
            FileUnit::Inch => "in",
            FileUnit::Millimetre => "mm",
            FileUnit::Centimetre => "cm",
            FileUnit::Metre => "",
        }
    }
}
