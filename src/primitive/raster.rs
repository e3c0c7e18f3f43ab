//! Fields of raster files: GeoTIFFs, and the luma of pictures.

use std::sync::Arc;

use super::plane;
use fretwork_action::{Action, Content, ReadLog, is_read_by_parts};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Affine, Bounds, Field, Lattice, Place, Point, Raster, Samples};
use fretwork_language::kinds::fields::{Interpolation, Raster as Kind};
use fretwork_source::geo::crs::{Crs, Transform};
use fretwork_source::geo::geotiff;
use fretwork_source::image::{self, Picture};

/// A field, and warnings.
pub type Made = Result<(Field, Vec<Diagnostic>), Vec<Diagnostic>>;

/// The values of a raster file: where a region or the file says, or for a picture one unit a pixel from the origin. Files
/// beside it that are read are noted in `log`.
pub fn field(action: &Action, kind: &Kind, log: &ReadLog) -> Made {
    let (path, content) = action.content(&kind.file.0)?;
    let (field, warnings) = if is_read_by_parts(&path) {
        let band = u64::from(kind.band.0);
        let raster = geotiff::open(content.source(), band);
        let raster = raster.map_err(|e| unreadable(action, &path, &e))?;
        let bytes = match content {
            Content::Bytes(bytes) => &bytes[..],
            Content::Parts { digest, .. } => digest,
        };
        let file = File {
            content: digest(bytes, &[band as f64]),
            samples: raster.blocks,
            frame: raster.frame,
            crs: raster.crs,
            path,
        };
        file.field(action, kind, log)?
    } else {
        let (path, bytes) = action.file(&kind.file.0)?;
        picture(action, kind, &path, &bytes, log)?
    };
    Ok((
        kind.otherwise
            .map_or(field.clone(), |value| field.filled(value.0)),
        warnings,
    ))
}

fn failed(action: &Action, message: String) -> Vec<Diagnostic> {
    vec![Diagnostic::error(message).at(action.span(), "in this field")]
}

fn unreadable(action: &Action, path: &str, error: &dyn std::error::Error) -> Vec<Diagnostic> {
    failed(action, format!("cannot read `{path}`: {error}"))
}

fn digest(bytes: &[u8], numbers: &[f64]) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    hasher.update(bytes);
    for number in numbers {
        hasher.update(&number.to_le_bytes());
    }
    *hasher.finalize().as_bytes()
}

/// A raster that may say where it lies.
struct File {
    samples: Arc<dyn Samples>,
    content: [u8; 32],
    frame: Option<Affine>,
    crs: Option<Crs>,
    path: Arc<str>,
}

impl File {
    fn field(mut self, action: &Action, kind: &Kind, log: &ReadLog) -> Made {
        if let Some(region) = &kind.region {
            let frame = over(action, action.input(region).bounds(), self.samples.size());
            return self
                .lattice(action, kind, frame, None)
                .map(|field| (field, Vec::new()));
        }
        if self.frame.is_none() {
            (self.frame, self.crs) = world(action, &self.path, log)?;
        }
        let Some(frame) = self.frame else {
            let message = format!(
                "`{}` has no georeference: it does not say where it lies",
                self.path
            );
            let error = Diagnostic::error(message).at(action.span(), "in this field");
            let help = "say with `region:` which region it covers, or put a world file beside it";
            return Err(vec![error.help(help)]);
        };
        if action.definition.map.is_none() {
            let message = format!("`{}` lies on a map, and this spec is none", self.path);
            let error = Diagnostic::error(message).at(action.span(), "in this field");
            let help = "add `map: {}` to the spec, or say with `region:` where the raster lies";
            return Err(vec![error.help(help)]);
        }
        let (transform, warnings) = plane::transform(action, self.crs.as_ref(), &self.path)?;
        let field = self.lattice(action, kind, frame, transform)?;
        Ok((field, warnings))
    }

    /// The longitude in the middle of the raster, if its plane is one of degrees.
    fn middle(&self, frame: Affine) -> Option<f64> {
        let [columns, rows] = self.samples.size().map(|n| n as f64 * 0.5);
        let is_geographic = self.crs.as_ref().is_some_and(Crs::is_geographic);
        is_geographic.then(|| frame.apply(Point::new(columns, rows)).x)
    }

    fn lattice(
        &self,
        action: &Action,
        kind: &Kind,
        frame: Affine,
        transform: Option<Transform>,
    ) -> Result<Field, Vec<Diagnostic>> {
        let names = transform
            .as_ref()
            .map(|t| format!("{t:?}"))
            .unwrap_or_default();
        let content = [&self.content[..], names.as_bytes()].concat();
        let content = digest(&content, &frame.0);
        let middle = self.middle(frame);
        let place = transform.map(|transform| place(transform, middle));
        let lattice = Lattice::new(self.samples.clone(), frame, place);
        let lattice = lattice.ok_or_else(|| {
            failed(
                action,
                format!("cannot read `{}`: its pixels have no size", self.path),
            )
        })?;
        let bilinear = kind.interpolate == Interpolation::Bilinear;
        Ok(Field::lattice(Arc::new(lattice), content, bilinear))
    }
}

/// The way around the earth in degrees.
const TURN: f64 = 360.0;

/// The way between the plane and that of a raster, which `transform` brings onto the plane. Longitudes are those nearest to
/// `middle`: a raster may lie on either side of ±180, and across it.
fn place(transform: Transform, middle: Option<f64>) -> Place {
    let nowhere = Point::new(f64::NAN, f64::NAN);
    let inverse = transform.inverse();
    let wrapped = move |p: Point| match middle {
        Some(middle) => Point::new(p.x + TURN * ((middle - p.x) / TURN).round(), p.y),
        None => p,
    };
    Place {
        into: Arc::new(move |p| inverse.apply(p).map_or(nowhere, wrapped)),
        back: Arc::new(move |p| transform.apply(p).unwrap_or(nowhere)),
        turn: middle.map(|_| TURN),
    }
}

/// From columns and rows to a box. The first row is the upper one, which on a map has the greatest y.
fn over(action: &Action, bounds: Bounds, size: [usize; 2]) -> Affine {
    let [columns, rows] = size.map(|n| n as f64);
    let (across, down) = (bounds.width() / columns, bounds.height() / rows);
    match action.definition.map {
        Some(_) => Affine([across, 0.0, 0.0, -down, bounds.min.x, bounds.max.y]),
        None => Affine([across, 0.0, 0.0, down, bounds.min.x, bounds.min.y]),
    }
}

/// What a world file beside the raster at `path` says of its place, and a `.prj` of its coordinate system.
fn world(
    action: &Action,
    path: &str,
    log: &ReadLog,
) -> Result<(Option<Affine>, Option<Crs>), Vec<Diagnostic>> {
    let own = path
        .rsplit_once('.')
        .map_or("", |(_, ending)| ending)
        .to_ascii_lowercase();
    let short = own.chars().next().zip(own.chars().last());
    let short = short.map_or(String::new(), |(a, z)| format!("{a}{z}w"));
    let endings = [short, format!("{own}w"), "wld".to_string()];
    let text = endings
        .iter()
        .find_map(|ending| plane::beside(action, path, ending, log));
    let Some(text) = text else {
        return Ok((None, None));
    };
    let frame = geotiff::world_file(&String::from_utf8_lossy(&text));
    let frame = frame.ok_or_else(|| {
        failed(
            action,
            format!("the world file beside `{path}` is not six numbers"),
        )
    })?;
    Ok((Some(frame), projection(action, path, log)?))
}

/// The coordinate system that a `.prj` beside the file at `path` describes, if there is one.
///
/// # Errors
/// When it cannot be used.
pub fn projection(
    action: &Action,
    path: &str,
    log: &ReadLog,
) -> Result<Option<Crs>, Vec<Diagnostic>> {
    let Some(text) = plane::beside(action, path, "prj", log) else {
        return Ok(None);
    };
    let crs = Crs::parse(&String::from_utf8_lossy(&text));
    let told = |e| Diagnostic::error(format!("the `.prj` beside `{path}`: {e}"));
    crs.map(Some)
        .map_err(|e| vec![told(e).at(action.span(), "read here")])
}

/// The luma of a picture.
fn picture(action: &Action, kind: &Kind, path: &Arc<str>, bytes: &[u8], log: &ReadLog) -> Made {
    if kind.band.0 != 1 {
        let message = format!(
            "a picture has one band, its luma, and no band {}",
            kind.band.0
        );
        return Err(failed(action, message));
    }
    let luma = image::luma(bytes).map_err(|e| unreadable(action, path, &e))?;
    let (black, white) = (kind.black.0, kind.white.0);
    let values: Vec<f64> = luma
        .values
        .iter()
        .map(|v| black + (white - black) * v)
        .collect();
    if kind.region.is_none() && action.definition.map.is_some() {
        let file = File {
            content: digest(bytes, &[black, white]),
            samples: Arc::new(Grey(Picture { values, ..luma })),
            frame: None,
            crs: None,
            path: path.clone(),
        };
        return file.field(action, kind, log);
    }
    let is_bilinear = kind.interpolate == Interpolation::Bilinear;
    let samples = spread(action, kind, luma.width, values);
    Ok((Field::raster(Arc::new(samples), is_bilinear), Vec::new()))
}

/// Samples over a region, or one unit a pixel from the origin. At their edges they go on.
fn spread(action: &Action, kind: &Kind, width: usize, values: Vec<f64>) -> Raster {
    let rows = values.len() / width.max(1);
    let bounds = match &kind.region {
        Some(region) => action.input(region).bounds(),
        None => {
            let size = Point::new(width as f64, rows as f64) * action.definition.own_unit();
            Bounds::of([Point::ORIGIN, size])
        }
    };
    let [across, _, _, down, x, y] = over(action, bounds, [width, rows]).0;
    Raster {
        origin: Point::new(x, y),
        step: Point::new(across, down),
        width,
        values,
    }
}

/// A picture as samples.
struct Grey(Picture<f64>);

impl Samples for Grey {
    fn size(&self) -> [usize; 2] {
        [self.0.width, self.0.values.len() / self.0.width.max(1)]
    }

    fn sample(&self, column: usize, row: usize) -> f64 {
        self.0.values[row * self.0.width + column]
    }
}
