//! `artifacts`: the files that a spec makes.

use super::look::Look;
use super::side::Side;
use crate::macros::{choice, kinds, record};
use crate::placement::SpacePlacement;
use crate::scalar::{Color, Count, OutputLength, PositiveLength, PositiveNumber, Scale, Text};
use crate::types::{Wanted, wants};
use crate::value::{Direction, Expectations, Named, NonEmpty, PageSize};
use crate::{Decode, Decoder, Ref, Tree, TypeSet, ValueType};

record! {
    /// A file that is made. Its key is its path in the spec's output folder; the extension chooses the format.
    pub struct Artifact {
        /// The page: arrangements are evaluated on this region, and of other things this part is shown.
        region: Option<Ref<wants::Region>>,
        /// A preview: so many copies of all that is shown, along x and along y, one period of the region apart, which must be periodic.
        /// In drawings and pictures of drawings.
        repeat: Option<Tiles>,
        /// How thick a cutout or a surface becomes, in solid formats, or the back of a facade behind its deepest shape (without it 1/50 of the longer side).
        thickness: Option<PositiveLength>,
        /// On which side of what a cutout lies on the thickness goes. Without it, the cutout's own `side`.
        side: Option<Side>,
        /// What the model's lengths are multiplied by; else by 1, and in drawings of maps by the map's scale. Plain output lengths (`stroke`, `kerf`) are millimetres then.
        scale: Option<Scale>,
        /// The coordinates of GeoJSON.
        crs: OutputCrs = "wgs84",
        /// The width of drawn lines, on the output.
        stroke: Option<OutputLength>,
        /// Whether areas are drawn by their outlines or filled, black where no style says otherwise. What
        /// encloses nothing stays a line.
        draw: Option<Draw>,
        /// What lies outside of the region is cut off.
        clip: bool = false,
        /// Lines are joined, and put in an order that moves the tool little. What is cut or drawn comes
        /// after what lies inside of it.
        optimize: bool = false,
        /// Looks of curves and areas by their labels, else by the name of the node; `*` is for all others. Labels are painted
        /// in this order, those without a look first, and numbers in their order. What has several labels has the looks of all,
        /// and where two say the same that of the first label.
        style: Named<Style> = Tree::map::<&str>([]),
        /// The full width of the tool's beam, on the output: outlines of parts are moved out by half of it,
        /// those of openings in. Which is which follows from how all lines that are cut lie in one another.
        kerf: OutputLength = 0,
        /// The size of the paper, in the middle of which the drawing stands; it must fit. Without it the page is what is drawn.
        page: Option<PageSize>,
        /// How much stays free around the drawing, on the output.
        margin: Option<OutputLength>,
        /// The width of a picture, in pixels.
        width: Option<Count>,
        /// How many pixels an inch of a drawing has in a picture, instead of `width`; the file says so too.
        dpi: Option<PositiveNumber>,
        /// What colours show in a picture of a shell.
        show: Option<Show>,
        /// The direction from the object to the viewer, in pictures of things in space.
        view: Option<Direction>,
        /// Values of params and lets, by name: one file for each combination. The path must tell them apart.
        each: Named<NonEmpty<Tree>> = Tree::map::<&str>([]),
        /// What its measures are expected to be: those of what it shows and, in formats of solids, of the body that it holds.
        /// Where one is not, the file is not written and that of the build before stays.
        expect: Expectations,
        /// Whether the file names its origin: the spec, the artifact, and digits that stand for all that it was made of.
        provenance: bool = true,
    }
    /// What it shows.
    + content: Content
}

kinds! {
    /// What an artifact shows.
    pub enum Content {
        /// One value.
        from: From(Ref<wants::Product>),
        /// Several values, each placed, and with its role.
        parts: Parts(NonEmpty<ArtifactPart>),
    }
}

record! {
    /// A part of an artifact.
    pub struct ArtifactPart {
        /// What it is.
        from: Ref<wants::Product>,
        /// What is done along its lines, in drawings. Without it they are cut; on maps drawn, unless there is a `kerf`.
        role: Option<Role>,
        /// The layer of all its lines in SVG and DXF. Without it, what their `style` says, else their label or the name of the node.
        layer: Option<LayerName>,
        /// The number of the pen that draws its lines, in the name of their layers, where plotters look for it.
        pen: Option<Count>,
        /// How thick a cutout or a surface becomes, in solid formats. Without it, as thick as the artifact says.
        thickness: Option<PositiveLength>,
        /// On which side of what the cutout lies on the thickness goes. Without it, the artifact's `side`, else the cutout's own.
        side: Option<Side>,
    }
    /// How it looks.
    + look: Look
    /// Where it stands; in drawings `z` is ignored.
    + placement: SpacePlacement
}

/// How often a tile is shown along x and along y.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(transparent)]
pub struct Tiles(pub [u32; 2]);

impl Tiles {
    /// More copies than this are no preview.
    pub const MOST: u64 = 1000;
}

impl Decode for Tiles {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Tiles> {
        let pair = tree.as_list().filter(|items| items.len() == 2);
        let Some(pair) = pair else {
            return cx.mismatch("two numbers of copies, as in `[3, 2]`", tree);
        };
        let counts: Vec<Count> = cx.items(pair)?;
        let [x, y] = [counts.first()?.0, counts.get(1)?.0];
        let total = u64::from(x) * u64::from(y);
        if total > Tiles::MOST {
            return cx.error(format!("{total} copies are more than {}", Tiles::MOST));
        }
        Some(Tiles([x, y]))
    }
}

impl schemars::JsonSchema for Tiles {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Tiles".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let count = g.subschema_for::<Count>();
        schemars::json_schema!({
            "description": "Numbers of copies along x and along y, as in `[3, 2]`.",
            "anyOf": [
                { "type": "array", "items": count, "minItems": 2, "maxItems": 2 },
                g.subschema_for::<crate::scalar::Expression>(),
            ],
        })
    }
}

/// The format of a file.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
pub enum Format {
    /// A drawing, in millimetres.
    Svg,
    /// A drawing for machines, in millimetres.
    Dxf,
    /// A mesh, in millimetres.
    Stl,
    /// Named meshes, in millimetres.
    ThreeMf,
    /// A scene with materials, in metres.
    Glb,
    /// A picture.
    Png,
    /// The measures that `inspect` prints.
    Json,
    /// Lines and areas of a map, for programs that know the ground.
    GeoJson,
}

impl Format {
    /// The extensions in the order of the formats.
    pub const EXTENSIONS: &[&str] = &["svg", "dxf", "stl", "3mf", "glb", "png", "json", "geojson"];

    /// The format of the file called `path`, by its extension in any case.
    pub fn of(path: &str) -> Option<Format> {
        let (stem, extension) = path.rsplit_once('.')?;
        let format = match &*extension.to_ascii_lowercase() {
            "svg" => Format::Svg,
            "dxf" => Format::Dxf,
            "stl" => Format::Stl,
            "3mf" => Format::ThreeMf,
            "glb" => Format::Glb,
            "png" => Format::Png,
            "json" => Format::Json,
            "geojson" => Format::GeoJson,
            _ => return None,
        };
        (!stem.is_empty() && !stem.ends_with('/')).then_some(format)
    }

    /// The types of values that the format can hold.
    pub fn accepts(self) -> TypeSet {
        use ValueType as V;
        match self {
            Format::Svg | Format::Dxf => TypeSet::of(&[
                V::Arrangement,
                V::Region,
                V::VectorExemplar,
                V::RasterExemplar,
                V::Cutout,
                V::Facade,
            ]),
            Format::Stl | Format::ThreeMf => TypeSet::of(&[
                V::Region,
                V::Cutout,
                V::Facade,
                V::Shell,
                V::Solid,
                V::Surface,
            ]),
            Format::Glb => TypeSet::of(&[
                V::Region,
                V::Cutout,
                V::Facade,
                V::Shell,
                V::Solid,
                V::Surface,
                V::Analysis,
            ]),
            Format::Png => wants::Product::TYPES,
            Format::Json => wants::Product::TYPES,
            Format::GeoJson => {
                TypeSet::of(&[V::Arrangement, V::Region, V::VectorExemplar, V::Cutout])
            }
        }
    }
}

choice! {
    /// The coordinates of a GeoJSON file.
    pub enum OutputCrs {
        /// Longitudes and latitudes of WGS 84 in degrees, as RFC 7946 has them.
        wgs84: Wgs84,
        /// Those of the map, in metres, with its coordinate system as a member `crs`.
        map: Map,
    }
}

impl Format {
    /// Whether a file shows a part of the plane, so that it can show a window of it.
    pub fn is_planar(self) -> bool {
        matches!(
            self,
            Format::Svg | Format::Dxf | Format::Png | Format::GeoJson
        )
    }
}

choice! {
    /// What colours show.
    pub enum Show {
        /// The stress in the body, from none to that which 99 % of it stay below.
        stress: Stress,
        /// What was added to the first pattern: bridges dark, what makes features wide enough light.
        bridges: Bridges,
    }
}

choice! {
    /// How areas are drawn.
    pub enum Draw {
        /// By their outlines.
        outline: Outline,
        /// Filled.
        filled: Filled,
    }
}

choice! {
    /// What is done along a line.
    pub enum Role {
        /// It is cut through.
        cut: Cut,
        /// It is engraved.
        engrave: Engrave,
        /// It is only drawn.
        draw: Draw,
    }
}

record! {
    /// A look.
    pub struct Style {
        /// The colour of areas and of what closed lines enclose, or `none`.
        fill: Option<Paint>,
        /// The colour of lines, or `none`; else red where they are cut and blue where they are engraved, in
        /// drawings, and black. DXF has the nearest colour of its own.
        stroke: Option<Paint>,
        /// The width of lines, on the output; else that of the artifact.
        width: Option<OutputLength>,
        /// The layer in SVG and DXF, which several labels may share if they look the same.
        layer: Option<LayerName>,
        /// The number of the pen, in the name of the layer, where plotters look for it.
        pen: Option<Count>,
    }
}

/// The name of a layer, which is not blank.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(transparent)]
pub struct LayerName(pub std::sync::Arc<str>);

impl Decode for LayerName {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<LayerName> {
        let name = Text::decode(tree, cx)?.0;
        if name.trim().is_empty() {
            return cx.error("the name of a layer is not blank");
        }
        Some(LayerName(name))
    }
}

impl schemars::JsonSchema for LayerName {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "LayerName".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let doc = "The name of a layer, which is not blank.";
        schemars::json_schema!({ "description": doc, "type": ["string", "number", "boolean"], "minLength": 1 })
    }
}

/// A colour, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Paint {
    /// Not drawn.
    None,
    /// Drawn in this colour.
    Color(Color),
}

impl Decode for Paint {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Paint> {
        match tree {
            Tree::Text(word) if &**word == "none" => Some(Paint::None),
            _ => Color::decode(tree, cx).map(Paint::Color),
        }
    }
}

impl schemars::JsonSchema for Paint {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Paint".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let doc = "A colour (`\"#rrggbb\"` in quotes, or a CSS colour such as `teal`), or `none`.";
        schemars::json_schema!({ "description": doc, "type": "string", "minLength": 1 })
    }
}
