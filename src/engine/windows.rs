//! Artifacts in windows: which parts of the plane a build was asked for, and the targets that they are.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::compile::Compiler;
use super::definition::basis;
use super::evaluate::{evaluate, value};
use super::local::without_reach;
use super::map_system::shared;
use super::target::Target;
use fretwork_action::{Definition, Input as _, Window};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::Bounds;
use fretwork_graph::NodeId;
use fretwork_language::kinds::artifacts::Format;
use fretwork_language::scalar::Text;
use fretwork_language::{Map, Node, wants};
use fretwork_source::geo::crs::Crs;

/// The deepest level of tiles: their sides are still many times what a coordinate is exact to.
pub const MAX_LEVEL: u8 = 30;
/// The most tiles that one build makes of an artifact.
const MAX_TILES: u64 = 1_000_000;
/// Where windows show more than this part of the page, the page is drawn once for all of them: around each of them more is
/// drawn than it shows.
const SHARED: f64 = 0.5;
/// Half the side of the web's plane in metres: half the equator of WGS 84.
const WEB: f64 = 20_037_508.342_789_244;

/// A part of the plane that a build is asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Cutting {
    /// A rectangle, and how it is called in paths.
    Window(Window, String),
    /// Tiles of a level.
    Tiles(TileRange),
}

/// Tiles of one level: columns from the west, rows from the north.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileRange {
    /// The level: its tiles are 2^level to a side.
    pub level: u8,
    /// The columns.
    pub x: TileSpan,
    /// The rows.
    pub y: TileSpan,
}

/// Which columns or rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TileSpan {
    /// This one, whatever is in it.
    One(u32),
    /// From one to another, as far as they meet the page.
    Between(u32, u32),
    /// All that meet the page.
    All,
}

/// The squares that divide a plane.
#[derive(Clone, Copy, Debug)]
struct Scheme {
    origin: [f64; 2],
    size: f64,
}

impl Scheme {
    /// That of a map; of the web's coordinate system that of the web.
    fn of(map: Option<&Map>) -> Option<Scheme> {
        let map = map?;
        if let Some(tiles) = &map.tiles {
            return Some(Scheme {
                origin: tiles.origin.0,
                size: tiles.size.0,
            });
        }
        let web = Crs::of_epsg(3857).ok()?;
        let own = Crs::parse(&map.crs.as_ref()?.0).ok()?;
        own.is_same(&web).then_some(Scheme {
            origin: [-WEB, WEB],
            size: 2.0 * WEB,
        })
    }

    /// The left side of a column, which is the right one of the column before, in the same bits.
    fn left(&self, level: u8, x: u32) -> f64 {
        tidy(self.origin[0] + self.size * (f64::from(x) / side(level)))
    }

    /// The upper side of a row, which is the lower one of the row above, in the same bits.
    fn top(&self, level: u8, y: u32) -> f64 {
        tidy(self.origin[1] - self.size * (f64::from(y) / side(level)))
    }

    fn window(&self, level: u8, x: u32, y: u32) -> Result<Window, String> {
        Window::new(
            [self.left(level, x), self.top(level, y + 1)],
            [self.left(level, x + 1), self.top(level, y)],
        )
    }

    /// The columns and the rows that meet a page, as first and last.
    fn meeting(&self, level: u8, page: &Bounds) -> [(u32, u32); 2] {
        let most = side(level) - 1.0;
        let tile = self.size / side(level);
        let place = |distance: f64| (distance / tile).floor().clamp(0.0, most) as u32;
        // A tile that the page only touches with its east or its south is none of it.
        let last = |distance: f64| ((distance / tile).ceil() - 1.0).clamp(0.0, most) as u32;
        [
            (
                place(page.min.x - self.origin[0]),
                last(page.max.x - self.origin[0]),
            ),
            (
                place(self.origin[1] - page.max.y),
                last(self.origin[1] - page.min.y),
            ),
        ]
    }
}

/// A side of a tile without what the sum of its origin and its size was rounded by: 24.1 less 24 is 0.1, where a page may end,
/// and not a little more. No file is as exact as a thousand-millionth of the map's unit.
fn tidy(side: f64) -> f64 {
    libm::round(side * 1e9) / 1e9
}

/// How many tiles of a level stand side by side.
fn side(level: u8) -> f64 {
    (1u64 << level) as f64
}

impl TileSpan {
    /// The greatest number that it names.
    fn last(self) -> u32 {
        match self {
            TileSpan::One(n) | TileSpan::Between(_, n) => n,
            TileSpan::All => 0,
        }
    }

    /// The first and the last one, of those that meet the page where it is not one alone.
    fn within(self, page: (u32, u32)) -> (u32, u32) {
        match self {
            TileSpan::One(n) => (n, n),
            TileSpan::Between(a, b) => (a.max(page.0), b.min(page.1)),
            TileSpan::All => page,
        }
    }
}

impl Compiler {
    /// The targets of `targets` in the parts of the plane that are asked for, each part once; the targets as
    /// they are where nothing is asked for. Artifacts that show no part of the plane are left out.
    pub(super) fn cut(
        &self,
        targets: Vec<Target>,
        cuttings: &[Cutting],
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Vec<Target> {
        if cuttings.is_empty() {
            return targets;
        }
        let mut cut = Vec::new();
        let mut paths = BTreeSet::new();
        let mut unbounded = BTreeMap::new();
        for target in targets {
            if !Format::of(&target.path).is_some_and(Format::is_planar) {
                let message = format!("`{}` shows no part of the plane", target.path);
                let warning = Diagnostic::warning(message).at(target.span.clone(), "left out");
                diagnostics.push(warning.help("name others with `--only`"));
                continue;
            }
            unbounded.extend(self.without_reach(&target));
            let mut of_target = Vec::new();
            for cutting in cuttings {
                match self.parts(&target, cutting) {
                    Ok(parts) => {
                        let new = parts.into_iter().filter(|t| paths.insert(t.path.clone()));
                        of_target.extend(new);
                    }
                    // What is wrong with a tile is so for every artifact.
                    Err(message) if diagnostics.iter().any(|d| d.message == message) => {}
                    Err(message) => {
                        let error = Diagnostic::error(message).at(target.span.clone(), "");
                        diagnostics.push(error);
                    }
                }
            }
            self.share(&target, &mut of_target);
            cut.extend(of_target);
        }
        diagnostics.extend(unbounded.into_values());
        cut
    }

    /// Notes where windows together show most of a page that what they show is drawn once for all of them.
    fn share(&self, target: &Target, parts: &mut [Target]) {
        if parts.len() < 2 {
            return;
        }
        let Ok(Some(page)) = self.page(target) else {
            return;
        };
        let area = |window: Window| {
            let ([x0, y0], [x1, y1]) = (window.low(), window.high());
            let width = x1.min(page.max.x) - x0.max(page.min.x);
            width.max(0.0) * (y1.min(page.max.y) - y0.max(page.min.y)).max(0.0)
        };
        let windows = parts.iter().filter_map(|part| part.job.window);
        if windows.map(area).sum::<f64>() < SHARED * page.width() * page.height() {
            return;
        }
        for part in parts {
            part.job.window = part.job.window.map(Window::shared);
        }
    }

    /// Warnings about the mappers below an artifact that do not say how far they reach, by the names of their nodes.
    fn without_reach(&self, target: &Target) -> BTreeMap<NodeId, Diagnostic> {
        let job = &target.job;
        let nodes = without_reach(&self.database, job.root, job.settings.clone(), &job.node);
        let warn = |(node, definition): (NodeId, Arc<Definition>)| {
            let message = format!(
                "`{}` is evaluated on all cells for a window: it does not say how far its curves reach",
                node.name
            );
            let warning = Diagnostic::warning(message).at(definition.span(), "in this arrangement");
            let help = "add `reach: LENGTH` to `map`: no curve leaves the box of its cell by more";
            (node, warning.help(help))
        };
        nodes.into_iter().map(warn).collect()
    }

    fn parts(&self, target: &Target, cutting: &Cutting) -> Result<Vec<Target>, String> {
        match cutting {
            Cutting::Window(window, name) => Ok(vec![in_window(target, *window, name)]),
            Cutting::Tiles(range) => self.tiles(target, *range),
        }
    }

    fn tiles(&self, target: &Target, range: TileRange) -> Result<Vec<Target>, String> {
        let job = &target.job;
        let basis = basis(&self.database, job.root, job.settings.clone());
        let map = basis.map.clone().map(|mut map| {
            let shared = || shared(&self.database, job.root, job.settings.clone());
            map.crs = map.crs.or_else(|| shared().crs.clone().map(Text));
            map
        });
        let Some(scheme) = Scheme::of(map.as_ref()) else {
            let advice = "add `tiles: { origin: [x, y], size: s }` to the head `map`";
            return Err(format!(
                "the spec says of no tiles where they lie; {advice}"
            ));
        };
        let level = range.level;
        let last = side(level) - 1.0;
        for (axis, span) in [("column", range.x), ("row", range.y)] {
            if f64::from(span.last()) > last {
                let message = format!(
                    "there is no tile of {axis} {} at level {level}",
                    span.last()
                );
                return Err(format!("{message}: the last one is {last}"));
            }
        }
        let is_one = matches!((range.x, range.y), (TileSpan::One(_), TileSpan::One(_)));
        let page = if is_one { None } else { self.page(target)? };
        // Where the page fails to be made, its own errors tell; there is no tile then.
        let Some([columns, rows]) = page
            .map(|page| scheme.meeting(level, &page))
            .or(is_one.then_some([(0, 0); 2]))
        else {
            return Ok(vec![target.clone()]);
        };
        let (x, y) = (range.x.within(columns), range.y.within(rows));
        let count =
            |(first, last): (u32, u32)| u64::from(last.saturating_add(1).saturating_sub(first));
        if count(x).saturating_mul(count(y)) > MAX_TILES {
            return Err(format!(
                "more than {MAX_TILES} tiles of level {level} meet the page"
            ));
        }
        let mut tiles = Vec::new();
        for column in x.0..=x.1 {
            for row in y.0..=y.1 {
                let window = scheme.window(level, column, row)?;
                tiles.push(in_window(
                    target,
                    window,
                    &format!("{level}/{column}/{row}"),
                ));
            }
        }
        Ok(tiles)
    }

    /// The box of the region that an artifact shows; none where that could not be made.
    fn page(&self, target: &Target) -> Result<Option<Bounds>, String> {
        let Some(definition) = target.job.definition(&self.database) else {
            return Ok(None);
        };
        let Node::Artifact(artifact) = &definition.node else {
            return Ok(None);
        };
        let Some(region) = &artifact.region else {
            let path = &target.path;
            return Err(format!(
                "a range of tiles of `{path}` needs a page: add `region: NAME`"
            ));
        };
        let job = target.job.of(definition.target(region), None);
        evaluate(&self.database, &job);
        let region = value(&self.database, &job);
        let region = region.as_ref().and_then(wants::Region::of);
        Ok(region.map(|region| region.bounds()))
    }
}

/// The target that shows a window: `a/b.svg` becomes `a/b/NAME.svg`.
fn in_window(target: &Target, window: Window, name: &str) -> Target {
    let (stem, extension) = target
        .path
        .rsplit_once('.')
        .unwrap_or((target.path.as_str(), ""));
    let mut cut = target.clone();
    cut.path = format!("{stem}/{name}.{extension}");
    cut.job.window = Some(window);
    cut
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Point;

    #[test]
    fn neighbouring_tiles_share_their_sides() {
        let scheme = Scheme {
            origin: [-WEB, WEB],
            size: 2.0 * WEB,
        };
        for level in [1, 7, 20] {
            let at = (1u32 << level) - 1;
            let (east, west) = (
                scheme.window(level, at, at),
                scheme.window(level, at - 1, at),
            );
            let (east, west) = (east.expect("a tile"), west.expect("a tile"));
            assert_eq!(west.high()[0].to_bits(), east.low()[0].to_bits());
            assert_eq!(west.low()[1].to_bits(), east.low()[1].to_bits());
        }
        let whole = scheme.window(0, 0, 0).expect("a tile");
        assert_eq!((whole.low(), whole.high()), ([-WEB; 2], [WEB; 2]));
    }

    #[test]
    fn ranges_meet_the_page() {
        let scheme = Scheme {
            origin: [0.0, 80.0],
            size: 80.0,
        };
        let page = Bounds {
            min: Point::new(15.0, 5.0),
            max: Point::new(25.0, 35.0),
        };
        assert_eq!(scheme.meeting(3, &page), [(1, 2), (4, 7)]);
        let touching = Bounds {
            min: Point::new(10.0, 10.0),
            max: Point::new(30.0, 40.0),
        };
        assert_eq!(scheme.meeting(3, &touching), [(1, 2), (4, 6)]);
        assert_eq!(TileSpan::Between(2, 6).within((4, 7)), (4, 6));
        assert_eq!(TileSpan::One(0).within((4, 7)), (0, 0));
    }
}
