//! Sheets on paper of a size, and with margins.

use super::page::Page;
use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::{Layer, Sheet};
use fretwork_geometry::{Bounds, Point};

/// What is larger than its page by less than this, in millimetres, fits.
const SLACK: f64 = 1e-6;

/// The sheet on the page that the artifact asks for: what it shows is in the middle, and the margin around it is free.
///
/// # Errors
/// When it does not fit, with what is left over.
pub fn on_page(mut sheet: Sheet, of: &Page<'_>) -> Result<Sheet, Diagnostic> {
    let artifact = of.artifact;
    let margin = artifact.margin.map_or(0.0, |margin| margin.0) / of.width_mm;
    let content = sheet.page_mm();
    let page = match artifact.page {
        None if margin == 0.0 => return Ok(sheet),
        None => content.grown(margin),
        Some(size) => {
            let [width, height] = size.0.map(|side| side / of.width_mm);
            let room = [width - 2.0 * margin, height - 2.0 * margin];
            if content.width() > room[0] + SLACK || content.height() > room[1] + SLACK {
                return Err(too_large(&content, room, of));
            }
            let half = Point::new(0.5 * width, 0.5 * height);
            Bounds {
                min: content.center() - half,
                max: content.center() + half,
            }
        }
    };
    let unit = 1.0 / sheet.unit_mm;
    sheet.page = Some(Bounds {
        min: page.min * unit,
        max: page.max * unit,
    });
    Ok(sheet)
}

/// A warning where a sheet that is shown whole has something beyond its page: of a page of a size how far it goes, of a region
/// which layers are not seen at all. What else a region cuts off is meant to be cut.
pub fn beyond(sheet: &Sheet, of: &Page<'_>) -> Option<Diagnostic> {
    if of.window.is_some() || of.artifact.clip || sheet.page.is_none() {
        return None;
    }
    let page = sheet.page_mm();
    let in_mm = |bounds: Bounds| Bounds {
        min: bounds.min * sheet.unit_mm,
        max: bounds.max * sheet.unit_mm,
    };
    let content = in_mm(sheet.content());
    if of.artifact.page.is_some() {
        let low = (page.min.x - content.min.x).max(page.min.y - content.min.y);
        let high = (content.max.x - page.max.x).max(content.max.y - page.max.y);
        let over = (low.max(high) * of.width_mm * 10.0).round() / 10.0;
        let told = || {
            let message = format!("what is drawn goes {over} mm beyond the page");
            Diagnostic::warning(message).help(
                "`region` stands in the middle of the page: make it larger, or leave it out so that all that is drawn is",
            )
        };
        return (over > 0.0).then(told);
    }
    let is_lost = |layer: &&Layer| {
        let bounds = layer.bounds();
        !bounds.is_empty() && !in_mm(bounds).intersects(&page)
    };
    let lost: Vec<String> = sheet
        .layers
        .iter()
        .filter(is_lost)
        .map(|layer| format!("`{}`", layer.name))
        .collect();
    (!lost.is_empty()).then(|| {
        let message = format!(
            "nothing of {} lies in the region that is shown",
            lost.join(", ")
        );
        Diagnostic::warning(message)
            .help("a larger `region` shows it, and without one all is shown")
    })
}

fn too_large(content: &Bounds, room: [f64; 2], of: &Page<'_>) -> Diagnostic {
    let rounded = |v: f64| (v * of.width_mm * 10.0).round() / 10.0;
    let [width, height] = [content.width(), content.height()];
    let message = format!(
        "what is drawn is {} × {} mm, and the page has room for {} × {} mm",
        rounded(width),
        rounded(height),
        rounded(room[0]),
        rounded(room[1])
    );
    let error = Diagnostic::error(message);
    let turned = width <= room[1] + SLACK && height <= room[0] + SLACK;
    if turned {
        return error.help("it fits when the page is turned: `landscape` after its name");
    }
    let fits = (room[0] / width).min(room[1] / height).max(0.0) * of.scale;
    // Lines stay as wide as they are at any scale, for which a hundredth is left.
    let fits = 0.99 * fits;
    if fits < 0.01 && fits > 0.0 {
        // Maps: the next round number.
        let least = 1.0 / fits;
        let round = libm::pow(10.0, libm::floor(libm::log10(least)) - 1.0);
        return error.help(format!(
            "it fits with `scale: \"1:{}\"`",
            (least / round).ceil() * round
        ));
    }
    let scale = (fits * 1e3).floor() / 1e3;
    error.help(format!("it fits with `scale: {scale}`"))
}
