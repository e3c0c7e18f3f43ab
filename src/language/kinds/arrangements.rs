//! `arrangements`: element textures made from partitions and from one another.

use crate::macros::{choice, kinds, record};
use crate::placement::{PlaneAxis, PlaneRepeat, PlaneScale};
use crate::scalar::{
    Angle, FilePath, Fraction, Label, Length, NonNegativeLength, PositiveLength, Scale, Text,
};
use crate::types::wants;
use crate::value::{Arguments, Direction, Named, NonEmpty, OneOrMany, PlanePoint, Range, Target};
use crate::{Decode, Decoder, Ref, Tree, ValueType};

use super::partitions::Border;
use super::side::Side;
use super::texts::Setting;
use super::wraps::Wrap;

kinds! {
    /// Element textures: functions from a region to a planar map of labelled curves.
    pub enum Arrangement {
        /// Every cell is replaced by what a script makes of it.
        map: Map(MapCells),
        /// An element is put at every cell: the usual cases of `map` without a script.
        place: Place(Place),
        /// The contours of faces, or edges, each transformed about the centre of its own bounding box.
        transform: Transform(Transform),
        /// An arrangement is drawn inside every face.
        fill: Fill(Fill),
        /// The curves of all of these.
        union: Union(NonEmpty<Ref<wants::Arrangement>>),
        /// What of an arrangement lies inside the faces of another.
        inside: Inside(Masked),
        /// What of an arrangement lies outside the faces of another.
        outside: Outside(Masked),
        /// The curves of an arrangement with other labels.
        relabel: Relabel(Relabel),
        /// An arrangement drawn in a tile, and copies of the tile all over the region.
        repeat: Repeat(Repeated),
        /// A last, random mapper over a regular arrangement.
        vary: Vary(MapCells),
        /// An arrangement that a function in a script makes; the function is called with `args`.
        script: Script(Script),
        /// The lines of a solid as it is seen from a direction: borders, silhouettes and creases, without what is hidden.
        projection: Projection(Projection),
        /// What is engraved on slices: the outline of the next one (labelled `outline`), their numbers (labelled `number`), and where
        /// a slice is wider than the one below it that one's outline (labelled `below`), for its lower side.
        registration: Registration(Registration),
        /// Letters of single lines, to be engraved or plotted.
        text: Text(Setting),
        /// Lines thickened and bridged into few pieces: a cutout.
        connect: Connect(Connect),
        /// A drawing laid on a surface: a cutout that `carve`, `emboss` and thickening take.
        wrap: Wrap(Wrap),
    }
}

impl Arrangement {
    /// A cutout for `connect` and `wrap`, an arrangement for all others.
    pub fn provides(&self) -> ValueType {
        if let Arrangement::Connect(_) | Arrangement::Wrap(_) = self {
            ValueType::Cutout
        } else {
            ValueType::Arrangement
        }
    }

    /// Whether it is a function of regions. A drawing of a thing is the same on all of them.
    pub fn is_function(&self) -> bool {
        !matches!(
            self,
            Arrangement::Connect(_)
                | Arrangement::Wrap(_)
                | Arrangement::Projection(_)
                | Arrangement::Registration(_)
                | Arrangement::Text(_)
        )
    }
}

kinds! {
    /// The cells of an arrangement that are mapped.
    pub enum Cells {
        /// Every vertex.
        vertices: Vertices(Ref<wants::Arrangement>),
        /// Every edge.
        edges: Edges(Ref<wants::Arrangement>),
        /// Every bounded face.
        faces: Faces(Ref<wants::Arrangement>),
    }
}

record! {
    /// Every cell replaced by what a script makes of it.
    pub struct MapCells {
        /// What makes curves of a cell.
        with: Mapper,
        /// A promise that no curve leaves the box of its cell by more; a longer one is an error. Without it `vary` promises
        /// the diagonal of the box, and `map` nothing.
        reach: Option<NonNegativeLength>,
    }
    /// The cells.
    + cells: Cells
}

/// What makes curves of a cell.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Mapper {
    /// Starlark with one function of a cell.
    Inline(Text),
    /// A function in a script.
    Script(Script),
}

impl Decode for Mapper {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Mapper> {
        match tree {
            Tree::Text(code) if code.trim().is_empty() => cx.error("the script is empty"),
            Tree::Text(code) => Some(Mapper::Inline(Text(code.clone()))),
            Tree::Map(_) => MapperScript::decode(tree, cx).map(|s| {
                Mapper::Script(Script {
                    file: s.script,
                    entry: s.entry,
                    args: s.args,
                })
            }),
            _ => cx.mismatch("Starlark text, or { script, entry, args }", tree),
        }
    }
}

impl schemars::JsonSchema for Mapper {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Mapper".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let inline = schemars::json_schema!({ "type": "string", "minLength": 1, "description": "Starlark text that defines one function of a cell." });
        let doc = "What makes curves of a cell: Starlark text that defines one function of a cell, or a function in a file that gives such a function.";
        schemars::json_schema!({ "description": doc, "anyOf": [inline, g.subschema_for::<MapperScript>()] })
    }
}

record! {
    /// A function in a script that gives a mapper: it is called with `args`, and what it gives is called with every cell.
    pub struct MapperScript {
        /// The script, in Starlark.
        script: FilePath,
        /// The function's name.
        entry: Text,
        /// What the function is called with, by name.
        args: Arguments = Tree::map::<&str>([]),
    }
}

record! {
    /// A function in a script that gives an arrangement: it is called with `args`.
    pub struct Script {
        /// The script, in Starlark.
        file: FilePath,
        /// The function's name.
        entry: Text,
        /// What the function is called with, by name.
        args: Arguments = Tree::map::<&str>([]),
    }
}

record! {
    /// An element at every cell.
    pub struct Place {
        /// What is put there; drawn at random from a list.
        element: OneOrMany<Ref<wants::VectorExemplar>>,
        /// The cells that get one: those with any of these labels. Without it, all.
        r#where: Option<OneOrMany<Label>>,
        /// The part of the cells that get one, drawn at random.
        chance: Fraction = 1,
        /// Edges: the point of the element that is put at an edge's start. Points are labelled in the drawing.
        from: Option<Text>,
        /// Edges: the point of the element that is put at an edge's end.
        to: Option<Text>,
        /// Edges: the part of the elements that are mirrored at their edge, drawn at random.
        flip: Fraction = 0,
        /// Faces: the point of the face where the centre of the element's bounding box is put.
        at: FacePoint = "centroid",
        /// How far the element is turned; `[least, greatest]` is drawn at random.
        rotate: Range<Angle> = 0,
        /// A factor; `[least, greatest]` is drawn at random.
        scale: Range<Scale> = 1,
        /// Faces: the element is first scaled so that its circle fills the face's inner one.
        fit: bool = false,
    }
    /// The cells.
    + cells: Cells
}

choice! {
    /// A point of a face.
    pub enum FacePoint {
        /// The centroid of its area.
        centroid: Centroid,
        /// The centre of its bounding box.
        center: Center,
    }
}

kinds! {
    /// The cells of an arrangement that have an extent.
    pub enum ExtendedCells {
        /// Every edge.
        edges: Edges(Ref<wants::Arrangement>),
        /// Every bounded face: its contour.
        faces: Faces(Ref<wants::Arrangement>),
    }
}

record! {
    /// The contours of faces, or edges, each transformed about the centre of its own bounding box.
    pub struct Transform {
        /// Faces: how far the contour moves inward, before all else.
        inset: Length = 0,
        /// A factor, or one for each axis.
        scale: PlaneScale = 1,
        /// The axis whose coordinate changes its sign.
        mirror: Option<PlaneAxis>,
        /// How far it is turned.
        rotate: Angle = 0,
        /// How far it is moved.
        at: PlanePoint = [0, 0],
        /// Copies of each, all of them transformed by the other words first; they turn about the same centre.
        repeat: Option<PlaneRepeat>,
    }
    /// The cells.
    + cells: ExtendedCells
}

record! {
    /// An arrangement drawn inside every face of another.
    pub struct Fill {
        /// The arrangement whose faces are filled.
        faces: Ref<wants::Arrangement>,
        /// What is drawn inside each.
        with: Ref<wants::Arrangement>,
    }
}

record! {
    /// An arrangement cut by the faces of another.
    pub struct Masked {
        /// The arrangement that is cut.
        input: Ref<wants::Arrangement>,
        /// The arrangement whose faces cut it.
        mask: Ref<wants::Arrangement>,
        /// What happens to edges at the border of those faces.
        border: Border = "crop",
    }
}

record! {
    /// Curves with other labels.
    pub struct Relabel {
        /// The arrangement.
        from: Ref<wants::Arrangement>,
        /// For labels those that stand in their place, one or several; `"*"` is for all that are not named. Labels without an entry
        /// stay.
        labels: Named<OneOrMany<Label>>,
    }
}

record! {
    /// Copies of a tile all over a region. On a periodic region they must close: a half drop needs
    /// an even number of columns, bricks an even number of rows, mirrored tiles both.
    pub struct Repeated {
        /// What is drawn in the tile, once. Where it reaches out of the tile, it reaches into those beside it.
        from: Ref<wants::Arrangement>,
        /// The tile: the box of this region, on which `from` is drawn.
        tile: Ref<wants::Region>,
        /// How the copies follow one another.
        layout: RepeatLayout = "straight",
        /// What happens to what lies across the border of the region.
        border: Border = "keep_outside",
    }
}

choice! {
    /// How copies of a tile follow one another, as printers of cloth and wallpaper call it.
    pub enum RepeatLayout {
        /// Side by side and one above the other.
        straight: Straight,
        /// Every second column is moved along y by half of the tile.
        half_drop: HalfDrop,
        /// Every second row is moved along x by half of the tile.
        brick: Brick,
        /// Every second column and every second row is mirrored, so that the sides of the tile meet themselves.
        mirrored: Mirrored,
    }
}

record! {
    /// The lines of a solid seen from a direction.
    pub struct Projection {
        /// The solid; facades, shells and surfaces too.
        of: Ref<wants::Solid>,
        /// The direction from it to the viewer; `[0, -1, 0]` is a front view, `[0, 0, 1]` a plan.
        from: Direction,
        /// Which lines there are. Each has one of the labels `border`, `silhouette`, `crease`, or `hidden` whatever it is.
        lines: ShownLines = "visible",
        /// From which angle on two faces meet in a crease.
        crease: Angle = 30,
    }
}

choice! {
    /// Which lines of a solid are drawn.
    pub enum ShownLines {
        /// Those that nothing lies before.
        visible: Visible,
        /// Hidden ones too.
        all: All,
    }
}

record! {
    /// What is engraved on slices.
    pub struct Registration {
        /// The slices, as `slices` made them.
        slices: Ref<wants::Region>,
        /// The size of the numbers, where there is room for it. Without it a fifteenth of the longer side of the largest slice.
        size: Option<PositiveLength>,
    }
}

record! {
    /// Lines thickened and bridged.
    pub struct Connect {
        /// The lines.
        input: Ref<wants::Arrangement>,
        /// The region that they are drawn in and cut to.
        region: Ref<wants::Region>,
        /// The width of a line.
        width: PositiveLength,
        /// The width of a frame along the border of the region, inside of it: the lines become one piece with it.
        frame: NonNegativeLength = 0,
        /// How many pieces there are to be.
        components: Target = 1,
        /// On which side of the drawing plane the thickness goes when the cutout becomes a solid: with `outside` it lies on the plane, with `inside` below it.
        side: Side = "outside",
    }
}
