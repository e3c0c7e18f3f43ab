//! `facades`: layers that are aligned and sized to a canvas.

use crate::macros::{choice, kinds, record};
use crate::scalar::{Color, FilePath, Fraction, Integer, Length, Letter, PositiveLength};
use crate::types::wants;
use crate::value::{Named, NonEmpty};
use crate::{Decode, Decoder, Ref, Tree};
use fretwork_diagnostic::Diagnostic;

record! {
    /// A layout of sized, placed shapes: layers of patterns, aligned and sized to fill a canvas.
    pub struct Facade {
        /// What is filled.
        canvas: Canvas,
        /// The counters of the patterns. Those that are not listed are found by the solver, from 1 up.
        counters: Counters = Tree::map::<&str>([]),
        /// The layers from bottom to top.
        layers: NonEmpty<Ref<wants::Layer>>,
        /// What stands in the cells. A key is `XY` (the symbols along x and y), `X*`, `*Y` or `*`; the most specific one is taken. `layer.XY` is for one layer.
        shapes: Shapes,
        /// The curve that the facade is laid along (towers, rings). Without it, it is flat.
        wrap: Option<Ref<wants::Curve>>,
    }
}

record! {
    /// The extent of a facade.
    pub struct Canvas {
        /// Along x.
        width: PositiveLength,
        /// Along y.
        height: PositiveLength,
    }
}

/// Counters by their letters, in order.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(transparent)]
pub struct Counters(pub Vec<(Letter, CounterRange)>);

/// The values that a counter may take, both ends included; `min <= max`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct CounterRange {
    /// The least.
    pub min: i64,
    /// The greatest; nothing where only the canvas is a limit.
    pub max: Option<i64>,
}

record! {
    /// The values that a counter may take.
    pub struct CounterForm {
        /// The least.
        min: Integer = 1,
        /// The greatest. Without it, what the canvas allows.
        max: Option<Integer>,
    }
}

impl Decode for CounterRange {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<CounterRange> {
        if !matches!(tree, Tree::Map(_)) {
            return Integer::decode(tree, cx).map(|n| CounterRange {
                min: n.0,
                max: Some(n.0),
            });
        }
        let form = CounterForm::decode(tree, cx)?;
        match form.max {
            Some(max) if max < form.min => cx.error("`max` is below `min`"),
            max => Some(CounterRange {
                min: form.min.0,
                max: max.map(|n| n.0),
            }),
        }
    }
}

impl schemars::JsonSchema for CounterRange {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Counter".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let doc = "The values that a counter may take: one, or `{ min: 1, max: 30 }`.";
        schemars::json_schema!({ "description": doc, "anyOf": [g.subschema_for::<Integer>(), CounterForm::json_schema(g)] })
    }
}

impl Decode for Counters {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Counters> {
        let named: Named<CounterRange> = Named::decode(tree, cx)?;
        by_key(named, Letter::of, "a counter is a single letter", cx).map(|mut counters| {
            counters.sort_by_key(|counter| counter.0);
            Counters(counters)
        })
    }
}

impl schemars::JsonSchema for Counters {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Counters".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let mut schema = Named::<CounterRange>::json_schema(g);
        schema.insert(
            "description".into(),
            "Counters of patterns by their letters.".into(),
        );
        schema
    }
}

/// The entries of a map whose keys mean something.
fn by_key<K, T>(
    named: Named<T>,
    read: fn(&str) -> Option<K>,
    what: &str,
    cx: &mut Decoder,
) -> Option<Vec<(K, T)>> {
    let mut fine = true;
    let mut entries = Vec::new();
    for (name, value) in named.0 {
        match read(&name) {
            Some(key) => entries.push((key, value)),
            None => {
                fine = false;
                cx.push(
                    Diagnostic::error(format!("{what}, not `{name}`"))
                        .at(cx.key_span_of(&name), ""),
                );
            }
        }
    }
    fine.then_some(entries)
}

/// Shapes by the cells that they stand in, in the order of the file.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(transparent)]
pub struct Shapes(pub Vec<(ShapeKey, Shape)>);

/// The cells that a shape stands in.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ShapeKey {
    /// In this layer alone.
    pub layer: Option<Ref<wants::Layer>>,
    /// With this symbol along x; any, if there is none.
    pub x: Option<Letter>,
    /// With this symbol along y; any, if there is none.
    pub y: Option<Letter>,
}

impl ShapeKey {
    /// Reads `XY`, `X*`, `*Y`, `*`, each alone or after `layer.`.
    pub fn of(text: &str) -> Option<ShapeKey> {
        let (layer, cells) = match text.rsplit_once('.') {
            Some((layer, cells)) if !layer.is_empty() => (Some(Ref::new(layer)), cells),
            Some(_) => return None,
            None => (None, text),
        };
        let chars: Vec<char> = cells.chars().collect();
        let letter = |c: char| {
            if c == '*' {
                Some(None)
            } else {
                c.is_alphabetic().then_some(Some(Letter(c)))
            }
        };
        match *chars {
            ['*'] => Some(ShapeKey {
                layer,
                x: None,
                y: None,
            }),
            [x, y] => Some(ShapeKey {
                layer,
                x: letter(x)?,
                y: letter(y)?,
            }),
            _ => None,
        }
    }
}

impl std::fmt::Display for ShapeKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if let Some(layer) = &self.layer {
            write!(f, "{}.", layer.name)?;
        }
        match (self.x, self.y) {
            (None, None) => f.write_str("*"),
            (x, y) => [x, y]
                .iter()
                .try_for_each(|letter| write!(f, "{}", letter.map_or('*', |c| c.0))),
        }
    }
}

impl Decode for Shapes {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Shapes> {
        let named: Named<Shape> = Named::decode(tree, cx)?;
        for (name, _) in named.iter() {
            if let Some(layer) = ShapeKey::of(name).and_then(|key| key.layer) {
                cx.reference_at_key(name, &layer);
            }
        }
        by_key(
            named,
            ShapeKey::of,
            "a key is `XY`, `X*`, `*Y`, `*`, or one of these after `layer.`",
            cx,
        )
        .map(Shapes)
    }
}

impl schemars::JsonSchema for Shapes {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Shapes".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let shape = g.subschema_for::<Shape>();
        let doc = "Shapes by the cells that they stand in: `XY`, `X*`, `*Y`, `*`, each alone or after `layer.`.";
        schemars::json_schema!({ "description": doc, "type": "object", "additionalProperties": shape })
    }
}

record! {
    /// What stands in a cell.
    pub struct Shape {
        /// How far it is moved out of the facade's plane; inward where it is below 0.
        offset: Length = 0,
        /// How it looks in GLB files and previews. Without it, light grey.
        material: Option<Material>,
        /// What is drawn in the cell, clipped to it: engraved in SVG and DXF, embossed in solids.
        fill: Option<Fill>,
    }
    /// Its form.
    + body: Body
}

kinds! {
    /// The form of a shape.
    pub enum Body {
        /// A box as large as the cell.
        r#box: Box(CellBox),
        /// A flat face as large as the cell.
        plane: Plane(CellPlane),
        /// A mesh (GLB, STL, OBJ, PLY), scaled to the cell: its x axis runs along the cell's width, its z axis up, and it is seen from -y; its depth is
        /// scaled by the smaller of the two factors.
        mesh: Mesh(FilePath),
        /// A solid of the spec, scaled to the cell as a mesh is.
        solid: Solid(Ref<wants::Solid>),
        /// A moulding: a cross-section that runs along the cells.
        moulding: Moulding(Moulding),
    }
}

record! {
    /// A cross-section that runs along the cells beside one another, and is mitred where the facade bends.
    pub struct Moulding {
        /// The cross-section: its left side lies on the facade, what is right of it stands out, and its upper side is up.
        profile: Ref<wants::Region>,
        /// Where it runs.
        along: MouldingRun = "row",
    }
}

choice! {
    /// Where a moulding runs.
    pub enum MouldingRun {
        /// Along the cells beside one another, scaled to their height; the whole way around a closed curve it has no ends.
        row: Row,
        /// Along the cells above one another, scaled to their width.
        column: Column,
        /// Around each cell, with mitred corners, as high as it is drawn; its upper side is at the cell's border.
        frame: Frame,
    }
}

record! {
    /// A box as large as the cell.
    pub struct CellBox {
        /// Its extent out of the facade's plane.
        depth: PositiveLength,
    }
}

record! {
    /// A flat face as large as the cell.
    pub struct CellPlane {}
}

/// What is drawn in a cell.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Fill {
    /// The arrangement, which is applied to the cell.
    pub with: Ref<wants::Arrangement>,
    /// How wide its lines are in solids.
    pub width: Option<PositiveLength>,
    /// How far its lines stand out in solids; below 0 they are grooves.
    pub height: Option<Length>,
}

record! {
    /// What is drawn in a cell, and how its lines stand out in solids.
    pub struct FillForm {
        /// The arrangement, which is applied to the cell.
        with: Ref<wants::Arrangement>,
        /// How wide its lines are in solids. Without it, 1/400 of the longer side of the canvas.
        width: Option<PositiveLength>,
        /// How far its lines stand out in solids; below 0 they are grooves. Without it, half of their width.
        height: Option<Length>,
    }
}

impl Decode for Fill {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Fill> {
        if let Tree::Map(_) = tree {
            let FillForm {
                with,
                width,
                height,
            } = FillForm::decode(tree, cx)?;
            return Some(Fill {
                with,
                width,
                height,
            });
        }
        Ref::decode(tree, cx).map(|with| Fill {
            with,
            width: None,
            height: None,
        })
    }
}

impl schemars::JsonSchema for Fill {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "CellFill".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let doc = "An arrangement, or `{ with: bricks, width: 0.02, height: -0.01 }`.";
        let forms = [
            g.subschema_for::<Ref<wants::Arrangement>>(),
            FillForm::json_schema(g),
        ];
        schemars::json_schema!({ "description": doc, "anyOf": forms })
    }
}

record! {
    /// A look.
    pub struct Material {
        /// The colour, with its opacity (`"#rrggbbaa"`); a picture is multiplied by it.
        color: Color = "#ffffff",
        /// A picture (PNG, JPEG), scaled to the cell.
        texture: Option<FilePath>,
        /// 1 for a metal, 0 for all else.
        metallic: Fraction = 0,
        /// 0 for a mirror, 1 for chalk.
        roughness: Fraction = 0.8,
    }
}
