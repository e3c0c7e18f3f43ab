//! The measures of values, as `inspect` prints them.

use serde_json::{Value as Json, json};

use fretwork_action::{Data, Value};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::cutout::mapped;
use fretwork_geometry::shell::{Statistics, Strength};
use fretwork_geometry::{
    Affine, Bounds, CurveLabels, Curves, Cutout, Facade, FacadeCell, Field, Model, Pixels,
    PlanarMap, Point, Polygon, Shell, SpaceCurve, planar_map, shell,
};
use fretwork_language::Node;
use fretwork_primitive::field::field;

/// The measures of `value` as a JSON object, in the spec's units. Curves are measured as the planar
/// map that they form on a region with these bounds, in a map with its resolution. `span` is the place of the node.
///
/// # Errors
/// When the value cannot be measured.
pub fn measure(
    value: &Value,
    bounds: Option<Bounds>,
    is_map: bool,
    span: &Span,
) -> Result<Json, Vec<Diagnostic>> {
    let failed =
        |message: String| vec![Diagnostic::error(message).at(span.clone(), "measured here")];
    let of_curves = |curves: &Curves| {
        let side = bounds.unwrap_or_else(|| curves.bounds()).longer_side();
        let resolution = if is_map {
            planar_map::MAP_RESOLUTION
        } else {
            planar_map::resolution(side)
        };
        PlanarMap::build(curves, resolution)
            .map(|map| of_map(&map, curves.bounds()))
            .map_err(|e| failed(e.to_string()))
    };
    match value {
        Value::Data(Data::Curves(curves)) => of_curves(curves),
        Value::Data(Data::Drawing(drawing)) => of_curves(&drawing.curves()),
        Value::Data(Data::Region(region)) => Ok(of_areas(&region.area)),
        Value::Data(Data::File(bytes)) => Ok(json!({ "bytes": bytes.len() })),
        Value::Data(Data::Curve(curve)) => Ok(of_curve(curve)),
        Value::Data(Data::Cutout(cutout)) => Ok(of_cutout(cutout)),
        Value::Data(Data::Surface(mesh)) => Ok(of_model(&Model::of("", mesh.mesh.clone()))),
        Value::Data(Data::Solid(model)) => Ok(of_model(model)),
        Value::Data(Data::Facade(facade)) => Ok(of_facade(facade)),
        Value::Data(Data::Pixels(pixels)) => Ok(of_pixels(pixels)),
        Value::Data(Data::Shell(shell)) => Ok(of_shell(shell)),
        Value::Data(Data::ShellStep(step)) => Ok(of_step(step)),
        Value::Data(Data::Analysis(body)) => Ok(of_strength(&body.strength)),
        Value::Deferred(action) => match (&action.definition.node, bounds) {
            (Node::Field(_), Some(bounds)) => field(action).map(|field| of_field(&field, bounds)),
            (Node::Field(_), None) => Err(failed("a field is measured on a region".to_string())),
            _ => Err(failed("it has no measures of its own".to_string())),
        },
    }
}

fn of_map(map: &PlanarMap, bounds: Bounds) -> Json {
    json!({
        "vertices": map.vertex_count(),
        "edges": map.edge_count(),
        "faces": map.face_count(),
        "components": map.component_count(),
        "length": map.length(),
        "area": map.area(),
        "bounds": corners(bounds),
    })
}

/// The values of a field at places, as a list of objects; `null` where it has none.
///
/// # Errors
/// When the value is no field. `span` is the place of the node.
pub fn values_at(value: &Value, at: &[[f64; 2]], span: &Span) -> Result<Json, Vec<Diagnostic>> {
    let of_field = match value {
        Value::Deferred(action) if matches!(action.definition.node, Node::Field(_)) => action,
        _ => {
            let message = "only fields, regions and arrangements are asked with `--at`";
            return Err(vec![
                Diagnostic::error(message).at(span.clone(), "this is none"),
            ]);
        }
    };
    let field = field(of_field)?;
    let asked = |[x, y]: &[f64; 2]| {
        let value = field.value(Point::new(*x, *y));
        json!({ "x": x, "y": y, "value": value.is_finite().then_some(value) })
    };
    Ok(at.iter().map(asked).collect())
}

/// A field's least, mean and greatest value on so many points along either side.
const SAMPLES: usize = 256;

fn of_field(field: &Field, bounds: Bounds) -> Json {
    let at = |i: usize| (i as f64 + 0.5) / SAMPLES as f64;
    let point = |i, j| bounds.min + Point::new(at(i) * bounds.width(), at(j) * bounds.height());
    let values = (0..SAMPLES)
        .flat_map(|j| (0..SAMPLES).map(move |i| (i, j)))
        .map(|(i, j)| field.value(point(i, j)));
    let known: Vec<f64> = values.filter(|v| v.is_finite()).collect();
    let of_known = |value: f64| if known.is_empty() { None } else { Some(value) };
    json!({
        "min": of_known(known.iter().copied().fold(f64::INFINITY, f64::min)),
        "mean": of_known(known.iter().sum::<f64>() / known.len() as f64),
        "max": of_known(known.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
        "defined": known.len() as f64 / (SAMPLES * SAMPLES) as f64,
    })
}

fn of_curve(curve: &SpaceCurve) -> Json {
    json!({
        "length": curve.length(),
        "closed": curve.is_closed(),
        "planar": curve.plane().is_some(),
    })
}

fn of_cutout(cutout: &Cutout) -> Json {
    let mut measures = json!({
        "components": cutout.components,
        "holes": cutout.holes,
        "length": cutout.measures.length,
        "area": cutout.measures.area,
        "min_width": cutout.measures.min_width,
        "bounds": corners(bounds_of(&cutout.flat())),
    });
    if let Some(wrapping) = &cutout.measures.wrapping {
        let [min, mean, max] = wrapping.stretch;
        measures["copies"] = json!(wrapping.copies);
        measures["around"] = json!(cutout.around);
        measures["surface_area"] = json!(wrapping.area);
        measures["stretch"] = json!({ "min": min, "mean": mean, "max": max });
        measures["flat"] = json!({
            "components": wrapping.flat.components,
            "holes": wrapping.flat.holes,
        });
    }
    if let Some(synthesis) = &cutout.measures.synthesis {
        measures["pieces_in"] = json!(synthesis.pieces_in);
        measures["pieces_out"] = json!(synthesis.pieces_out);
        measures["pieces"] = json!(synthesis.pieces);
        measures["seam_cost"] = json!(synthesis.seam_cost);
    }
    measures
}

fn of_model(model: &Model) -> Json {
    let topology = model.topology();
    let bounds = model.bounds();
    let is_closed = topology.open_edges == 0 && topology.bad_edges == 0;
    let cavities = if is_closed { cavities(model) } else { 0 };
    json!({
        "parts": model.parts.len(),
        "triangles": model.triangle_count(),
        "watertight": is_closed,
        "components": topology.components - cavities,
        "cavities": cavities,
        "genus": topology.genus,
        "volume": model.volume(),
        "area": model.area(),
        "bounds": [bounds.min, bounds.max],
    })
}

fn of_pixels(pixels: &Pixels) -> Json {
    json!({
        "width": pixels.width,
        "height": pixels.height(),
        "pixel_size": pixels.pixel_size,
        "tileable": pixels.tileable,
        "solid_fraction": pixels.solid_fraction(),
    })
}

fn of_step(step: &shell::Step) -> Json {
    let solid = |solid: &[bool]| solid.iter().filter(|solid| **solid).count();
    match step {
        shell::Step::Voxels(surface) => json!({ "voxels": surface.voxels.len() }),
        shell::Step::Pattern { pattern, .. } => json!({
            "voxels": pattern.solid.len(),
            "solid_voxels": solid(&pattern.solid),
        }),
        shell::Step::Structure(structure) => json!({
            "voxels": structure.solid.len(),
            "solid_voxels": solid(&structure.solid),
            "iterations": structure.iterations,
        }),
    }
}

/// The figures of a shell, with those of its mesh.
fn of_shell(shell: &Shell) -> Json {
    let measures = &shell.measures;
    let mut json = of_model(&Model::of("", shell.mesh.clone()));
    json["voxels"] = json!(measures.voxels);
    json["solid_voxels"] = json!(measures.solid_voxels);
    json["voxel"] = json!(measures.voxel);
    json["components"] = json!(measures.components);
    json["iterations"] = json!(measures.iterations);
    json["done"] = json!(measures.is_done);
    json["bridges"] = json!({
        "connection": measures.bridges.connection,
        "stress": measures.bridges.stress,
        "geodesic": measures.bridges.geodesic,
    });
    json["solid_fraction"] = json!({
        "exemplar": measures.exemplar_fraction,
        "before": measures.fraction[0],
        "after": measures.fraction[1],
    });
    json["min_feature"] = json!(measures.min_feature);
    if let Some(strength) = &measures.strength {
        let found = of_strength(strength);
        let fields = found.as_object().into_iter().flatten();
        fields.for_each(|(name, value)| json[name] = value.clone());
    }
    json
}

/// Stresses in Pa, displacements in the spec's unit.
fn of_strength(strength: &Strength) -> Json {
    let distribution = |of: &Statistics| json!({ "mean": of.mean, "median": of.median, "p99": of.p99, "max": of.max });
    let mut json = json!({
        "elements": strength.elements,
        "stress": distribution(&strength.stress),
        "von_mises": distribution(&strength.von_mises),
        "max_displacement": strength.max_displacement,
        "displacement_at": strength.displacement_at,
        "weakest_at": strength.weakest_at,
        "mass": strength.mass,
        "safety_factor": of_safety(strength.safety_factor),
        "residual": strength.residual,
        "solver_iterations": strength.iterations,
    });
    if let Some(worst) = &strength.worst_gravity {
        json["worst_gravity"] = json!({
            "direction": worst.direction,
            "p99": worst.p99,
            "safety_factor": of_safety(worst.safety_factor),
            "weakest_at": worst.weakest_at,
            "max_displacement": worst.max_displacement,
        });
    }
    json
}

/// The safety factors: null where nothing strains the body, so that no number of times its stress is its strength.
fn of_safety(factors: Option<[f64; 2]>) -> Json {
    let [p99, max] = [0, 1].map(|i| factors.map(|factors| factors[i]));
    json!({ "p99": p99, "max": max })
}

/// How many closed surfaces of a model bound what is empty inside of a body. They are no bodies of their own.
fn cavities(model: &Model) -> usize {
    let bodies = model.parts.iter().map(|part| model.mesh(part));
    let pieces = bodies.flat_map(|mesh| mesh.components());
    pieces.filter(|piece| piece.volume() < 0.0).count()
}

fn of_facade(facade: &Facade) -> Json {
    let layout = &facade.layout;
    let seen = facade.seen();
    let shape = |(number, cell): (usize, &FacadeCell)| {
        json!({
            "layer": layout.layers[cell.layer as usize],
            "symbol_x": cell.symbol_x,
            "symbol_y": cell.symbol_y,
            "x": cell.x,
            "y": cell.y,
            "width": cell.width,
            "height": cell.height,
            "shape": facade.shape(number).map(|shape| &shape.name),
            "visible": seen[number],
        })
    };
    json!({
        "columns": layout.columns(),
        "rows": layout.rows(),
        "width": layout.width,
        "height": layout.height,
        "x": layout.x,
        "y": layout.y,
        "layers": layout.layers,
        "shapes": layout.cells.iter().enumerate().map(shape).collect::<Vec<_>>(),
        "alignment_error": layout.alignment_error,
        "size_error": layout.size_error,
    })
}

fn of_areas(area: &[Polygon]) -> Json {
    json!({
        "components": area.len(),
        "holes": area.iter().map(|p| p.holes.len()).sum::<usize>(),
        "area": area.iter().map(Polygon::area).sum::<f64>(),
        "bounds": corners(bounds_of(area)),
    })
}

fn bounds_of(area: &[Polygon]) -> Bounds {
    area.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()))
}

/// The corners of a box; nothing for that of nothing.
fn corners(bounds: Bounds) -> Json {
    if bounds.is_empty() {
        Json::Null
    } else {
        json!([bounds.min, bounds.max])
    }
}

/// The measures of several values as they are drawn together, each in all its places: areas by their sums and the
/// narrowest of their places, where all are areas, and else the planar map that their lines form.
///
/// # Errors
/// When a value cannot be drawn.
pub fn measure_drawn(
    parts: &[(&Value, Vec<Affine>)],
    bounds: Option<Bounds>,
    is_map: bool,
    span: &Span,
) -> Result<Json, Vec<Diagnostic>> {
    let (mut area, mut lines) = (Vec::new(), Curves::new());
    let mut narrowest: Option<f64> = None;
    for (value, maps) in parts {
        let own = match value {
            Value::Data(Data::Region(region)) => &region.area[..],
            Value::Data(Data::Cutout(cutout)) => &cutout.flat()[..],
            _ => &[],
        };
        let drawn = match value {
            Value::Data(Data::Curves(curves)) => (**curves).clone(),
            Value::Data(Data::Drawing(drawing)) => drawing.curves(),
            _ => Curves::new(),
        };
        for map in maps {
            area.extend(mapped(own, |p| map.apply(p)));
            lines.append(&drawn.transformed(map));
            if let Value::Data(Data::Cutout(cutout)) = value
                && let Some(width) = cutout.measures.min_width
            {
                let width = width * map.determinant().abs().sqrt();
                narrowest = Some(narrowest.map_or(width, |least| least.min(width)));
            }
        }
    }
    if lines.is_empty() {
        let mut measures = of_areas(&area);
        if narrowest.is_some() {
            measures["min_width"] = json!(narrowest);
        }
        return Ok(measures);
    }
    for ring in area.iter().flat_map(Polygon::rings) {
        let closed = ring.iter().chain(ring.first()).copied();
        lines.push(closed, CurveLabels::default());
    }
    let whole = Value::Data(Data::Curves(lines.into()));
    measure(&whole, bounds, is_map, span)
}
