//! Pictures of what differs: drawings as SVG, bodies as GLB and PNG.

use std::fmt::Write as _;

use super::{Overlay, Pieces, Sketch};
use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::Color;
use fretwork_fabricate::format::glb;
use fretwork_fabricate::picture::solid::{self, View};
use fretwork_geometry::{Bounds, Model, Point, Point3, Polygon};

/// The colour of what both have.
pub const COMMON: [u8; 3] = [0x9a, 0x9a, 0x9a];
/// The colour of what was only before.
pub const REMOVED: [u8; 3] = [0xc1, 0x12, 0x1f];
/// The colour of what is only after.
pub const ADDED: [u8; 3] = [0x0a, 0x93, 0x96];

/// The width of pictures of bodies in pixels, and from where they are seen: as an artifact that does not say.
const WIDTH: u32 = 1024;
const VIEW: [f64; 3] = [1.0, -2.0, 1.2];

/// The files that show an overlay, by their extensions.
///
/// # Errors
/// When a body cannot be shown.
pub fn files(overlay: &Overlay) -> Result<Vec<(&'static str, Vec<u8>)>, Diagnostic> {
    match overlay {
        Overlay::Drawing(sketch) => Ok(vec![("svg", svg(sketch))]),
        Overlay::Body(model) => Ok(vec![
            ("glb", glb::write(model, 1.0, None)?),
            ("png", png(model)?),
        ]),
    }
}

/// A picture of bodies.
///
/// # Errors
/// When there is nothing to be shown.
pub fn png(model: &Model) -> Result<Vec<u8>, Diagnostic> {
    let view = View {
        width: WIDTH,
        direction: Point3::from(VIEW),
        background: Some(Color([255; 3])),
    };
    solid::write(model, &view)
}

/// Drawings laid over one another, in millimetres: what both have is grey, what was removed is hatched, what was added filled;
/// of lines those that were removed are dashed.
pub fn svg(sketch: &Sketch) -> Vec<u8> {
    let page = sketch.page.filter(|page| !page.is_empty());
    let page = page.unwrap_or(Bounds {
        min: Point::ORIGIN,
        max: Point::new(1.0, 1.0),
    });
    let side = page.longer_side().max(1e-9);
    let page = page.grown(side / 100.0);
    let [x, y, w, h] = [page.min.x, page.min.y, page.width(), page.height()].map(number);
    let mut out = head([&x, &y, &w, &h], side);
    let [thin, wide, step, gap] = [600.0, 250.0, 60.0, 120.0].map(|share| number(side / share));
    let dashes = format!(" stroke-dasharray=\"{step} {gap}\"");
    let [common, removed, added] = [COMMON, REMOVED, ADDED].map(hex);
    let width = match sketch.all.areas.is_empty() {
        true => &thin,
        false => &wide,
    };
    let looks = [
        ("common", &sketch.all, (&*common, &*common), width, ""),
        (
            "removed",
            &sketch.removed,
            ("url(#hatch)", &*removed),
            &wide,
            &*dashes,
        ),
        ("added", &sketch.added, (&*added, &*added), &wide, ""),
    ];
    for (name, pieces, (fill, stroke), width, dashes) in looks {
        if !(pieces.areas.is_empty() && pieces.lines.is_empty()) {
            out += &format!("<g id=\"{name}\" stroke=\"{stroke}\">\n");
            push_pieces(&mut out, pieces, fill, [&thin, width], dashes);
            out += "</g>\n";
        }
    }
    out += "</svg>\n";
    out.into_bytes()
}

/// The begin of the file: the page, what hatches, and white paper.
fn head([x, y, w, h]: [&str; 4], side: f64) -> String {
    let [step, half] = [60.0, 120.0].map(|share| number(side / share));
    let red = hex(REMOVED);
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}mm\" height=\"{h}mm\" viewBox=\"{x} {y} {w} {h}\" \
         stroke-linecap=\"round\" stroke-linejoin=\"round\" fill-rule=\"evenodd\">\n\
         <defs><pattern id=\"hatch\" width=\"{step}\" height=\"{step}\" patternUnits=\"userSpaceOnUse\" \
         patternTransform=\"rotate(45)\"><rect width=\"{step}\" height=\"{step}\" fill=\"#ffffff\"/>\
         <rect width=\"{half}\" height=\"{step}\" fill=\"{red}\"/></pattern></defs>\n\
         <rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>\n"
    )
}

/// Areas with outlines and lines of these widths. Each area is an element, for areas may overlap.
fn push_pieces(out: &mut String, pieces: &Pieces, fill: &str, widths: [&str; 2], dashes: &str) {
    let [thin, width] = widths;
    if !pieces.areas.is_empty() {
        *out += &format!("<g fill=\"{fill}\" stroke-width=\"{thin}\">\n");
        for area in &pieces.areas {
            push_area(out, area);
        }
        *out += "</g>\n";
    }
    if pieces.lines.is_empty() {
        return;
    }
    let mut data = String::new();
    for line in &pieces.lines {
        push_line(&mut data, line, false);
    }
    // On an area of the same colour a line is seen by the light on both sides of it.
    if !pieces.areas.is_empty() {
        *out += &format!(
            "<path fill=\"none\" stroke=\"#ffffff\" stroke-width=\"{width}\" d=\"{data}\"/>\n"
        );
    }
    let width = if pieces.areas.is_empty() { width } else { thin };
    *out += &format!("<path fill=\"none\" stroke-width=\"{width}\"{dashes} d=\"{data}\"/>\n");
}

fn push_area(out: &mut String, area: &Polygon) {
    *out += "<path d=\"";
    for ring in area.rings() {
        push_line(out, ring, true);
    }
    *out += "\"/>\n";
}

fn push_line(out: &mut String, line: &[Point], is_closed: bool) {
    for (number_of, p) in line.iter().enumerate() {
        let command = if number_of == 0 { 'M' } else { 'L' };
        write!(out, "{command}{} {}", number(p.x), number(p.y))
            .expect("a string takes all that is written");
    }
    if is_closed {
        out.push('Z');
    }
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A number to 10^-4.
fn number(v: f64) -> String {
    let rounded = (v * 1e4).round() / 1e4 + 0.0;
    rounded.to_string()
}
