//! Whether an area is painted: colours, gradients, patterns, and what is not there.

use roxmltree::Node;

use super::super::document::{XLINK, name};
use super::super::sheet;
use super::super::style::{Paint, opacity};
use super::Walk;

/// How far a gradient or a pattern is followed to the one that it takes its content from.
const MOST_STEPS: usize = 16;

impl<'a, 'input> Walk<'a, 'input> {
    /// Whether `paint` paints anything on a shape; what is not read of it is told.
    pub fn paints(&mut self, node: Node<'a, 'input>, paint: Paint<'a>) -> bool {
        let Paint::Server { id, fallback } = paint else {
            return paint != Paint::None;
        };
        let server = self.ids.get(id).copied();
        match server.and_then(|server| Some((server, name(server)?))) {
            Some((server, "linearGradient" | "radialGradient")) => {
                let stops = self.content(server, "stop");
                stops.is_some_and(|of| stops_of(of).any(is_seen))
            }
            Some((server, "pattern")) => {
                let has_content = self.content(server, "").is_some();
                if has_content {
                    let help = "the area is read as a whole; convert the pattern to objects";
                    self.report.unread(node, "a pattern as paint", help);
                }
                has_content
            }
            _ => fallback.unwrap_or_else(|| {
                let message = format!("the paint server `{id}` is not in the drawing");
                let help = "nothing is painted with it, as in browsers; give the shape a colour";
                self.report.note(node, message, help);
                false
            }),
        }
    }

    /// The gradient or pattern from which `server` takes its content: itself, or one that it refers to. `tag` is
    /// what the content consists of; any element where it is empty.
    fn content(&self, server: Node<'a, 'input>, tag: &str) -> Option<Node<'a, 'input>> {
        let mut at = server;
        for _ in 0..MOST_STEPS {
            let is_content = |n: Node| name(n).is_some_and(|t| tag.is_empty() || t == tag);
            if at.children().any(is_content) {
                return Some(at);
            }
            let href = at.attribute("href").or(at.attribute((XLINK, "href")))?;
            at = *self.ids.get(href.trim().strip_prefix('#')?)?;
        }
        None
    }
}

fn stops_of<'a, 'input>(gradient: Node<'a, 'input>) -> impl Iterator<Item = Node<'a, 'input>> {
    gradient.children().filter(|n| name(*n) == Some("stop"))
}

/// Whether a stop of a gradient is not transparent.
fn is_seen(stop: Node) -> bool {
    let said = |property: &str| {
        let style = stop.attribute("style").unwrap_or("");
        let found = sheet::declarations(style).filter(|d| d.name == property);
        let in_style = found.last().map(|d| d.value.to_string());
        in_style.or(stop.attribute(property).map(str::to_string))
    };
    let is_opaque = |text: String| opacity(&text).is_none_or(|o| o > 0.0);
    let color = said("stop-color").unwrap_or_default();
    let is_transparent = color.parse::<svgtypes::Color>().is_ok_and(|c| c.alpha == 0)
        || color.eq_ignore_ascii_case("transparent");
    said("stop-opacity").is_none_or(is_opaque) && !is_transparent
}
