//! The head `map:`: what makes the plane of a spec that of a map, and what a map spec is. Coordinate systems
//! are kept as text here; what they mean is known to those who transform.

use super::macros::record;
use super::scalar::{PositiveLength, Scale, Text};
use super::value::PlanePoint;
use super::{Decode, DecodeContext, Decoder, Node, Tree};
use crate::kinds::{
    arrangements::Arrangement, curves::Curve, exemplars::Exemplar, fields::Field, regions::Region,
};
use fretwork_diagnostic::Diagnostic;

record! {
    /// The plane of a map: x goes east, y north, lengths are measured in metres on the ground, and `units` is `m` unless
    /// the file says otherwise. `map: {}` is a plane in metres. A region from `geodata` makes a map as well.
    pub struct Map {
        /// The coordinate system of the plane, projected and in metres: `EPSG:n`, a PROJ string or WKT. Without it, that of the
        /// inputs that have one.
        crs: Option<Text>,
        /// The scale of drawings, as `"1:25000"`: SVG and DXF are millimetres of paper then, and expressions know `paper_mm`, the
        /// metres of one millimetre on paper.
        scale: Option<Scale>,
        /// How `--tile Z/X/Y` divides the plane.
        tiles: Option<Tiles>,
        /// Random values depend on positions rounded to this.
        resolution: PositiveLength = "1mm",
    }
}

record! {
    /// Squares that divide the plane: tile 0/0/0 is the whole, and each next level halves their sides.
    pub struct Tiles {
        /// The upper left corner, which is in the west and north.
        origin: PlanePoint,
        /// The side of tile 0/0/0.
        size: PositiveLength,
    }
}

impl Map {
    /// The parts of the map that the value of `node` can depend on, so that an edit of the others is none of it.
    pub fn seen_by(&self, node: &Node) -> Map {
        let is_artifact = matches!(node, Node::Artifact(_));
        let has_place = matches!(
            node,
            Node::Region(Region::Geodata(_)) | Node::Field(Field::Raster(_) | Field::Attribute(_))
        );
        Map {
            crs: self.crs.clone().filter(|_| is_artifact || has_place),
            scale: self.scale.filter(|_| is_artifact || is_curved(node)),
            tiles: None,
            resolution: self.resolution,
        }
    }

    /// The metres of one millimetre on paper, if there is a scale.
    pub fn paper_mm(&self) -> Option<f64> {
        self.scale.map(|scale| 1e-3 / scale.0)
    }
}

/// Whether polylines of a node may stand for curves of drawings and letters, those that scripts import among them.
fn is_curved(node: &Node) -> bool {
    matches!(
        node,
        Node::Exemplar(Exemplar::Vector(_))
            | Node::Curve(Curve::Svg(_))
            | Node::Region(Region::Svg(_) | Region::Text(_))
            | Node::Arrangement(
                Arrangement::Map(_) | Arrangement::Vary(_) | Arrangement::Script(_)
            )
    )
}

/// The head `map` after its expressions were replaced; nothing under the key is an empty map. The path of
/// `context` is that of the file, empty.
///
/// # Errors
/// All that is wrong with its fields.
pub fn decode_map(tree: &Tree, context: &DecodeContext) -> Result<Map, Vec<Diagnostic>> {
    let mut cx = Decoder::new(context);
    let empty = Tree::map::<&str>([]);
    let tree = if *tree == Tree::Null { &empty } else { tree };
    let map = cx.at("map", |cx| Map::decode(tree, cx));
    match map {
        Some(map) if !cx.diagnostics.iter().any(Diagnostic::is_error) => Ok(map),
        _ => Err(cx.diagnostics),
    }
}

/// Whether the file `tree` is a map by itself: it has the head `map`, or a region from `geodata`.
pub(super) fn is_map(tree: &Tree) -> bool {
    let regions = tree.get("regions").and_then(Tree::as_map);
    let mut regions = regions.into_iter().flatten();
    tree.get("map").is_some() || regions.any(|(_, region)| region.get("geodata").is_some())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unit;

    fn read(text: &str) -> Result<Map, Vec<String>> {
        let parsed = crate::parse(&"f.yaml".into(), text);
        assert_eq!(parsed.diagnostics, []);
        let context = DecodeContext {
            file: "f.yaml".into(),
            path: Vec::new(),
            file_units: parsed.document.units,
            spec_units: Unit::Metre,
            is_scaled: false,
            modules: Default::default(),
        };
        let map = parsed.document.map.expect("the file has a map");
        decode_map(&map, &context).map_err(|all| all.into_iter().map(|d| d.message).collect())
    }

    #[test]
    fn every_field_of_a_map_is_optional() {
        let empty = Map {
            crs: None,
            scale: None,
            tiles: None,
            resolution: PositiveLength(0.001),
        };
        assert_eq!(read("fretwork: 1\nmap: {}"), Ok(empty.clone()));
        assert_eq!(read("fretwork: 1\nmap:"), Ok(empty));
        let full = "fretwork: 1\nmap: { crs: \"EPSG:32616\", scale: \"1:25000\", tiles: { origin: [1, 2], size: 3 }, resolution: 0.5 }";
        let full = read(full).expect("a map");
        assert_eq!(full.paper_mm(), Some(25.0));
        assert_eq!(full.resolution.0, 0.5);
        assert_eq!(full.tiles.expect("it has tiles").origin.0, [1.0, 2.0]);
    }

    #[test]
    fn lengths_of_a_map_may_be_in_another_unit() {
        let map = read("fretwork: 1\nunits: cm\nmap: { resolution: 1 }").expect("a map");
        assert_eq!(map.resolution.0, 0.01);
    }

    #[test]
    fn wrong_fields_of_a_map_are_told() {
        let errors = read("fretwork: 1\nmap: { scala: 5, tiles: { origin: [0, 0] } }");
        assert_eq!(errors.map_err(|all| all.len()), Err(2));
        assert!(read("fretwork: 1\nmap: 3").is_err());
    }

    #[test]
    fn units_of_a_map_are_metres() {
        let units = |text: &str| crate::parse(&"f.yaml".into(), text).document.units;
        assert_eq!(units("fretwork: 1\nmap: {}"), Unit::Metre);
        let geodata = "fretwork: 1\nregions: { land: { geodata: { file: a.shp } } }";
        assert_eq!(units(geodata), Unit::Metre);
        assert_eq!(units("fretwork: 1\nunits: mm\nmap: {}"), Unit::Millimetre);
        assert_eq!(units("fretwork: 1"), Unit::Millimetre);
    }
}
