//! Bytes to text to XML tree.

use std::sync::Arc;

use roxmltree::{Document, Node, ParsingOptions, TextPos};

use super::guard;
use fretwork_diagnostic::{Diagnostic, Span};

/// The namespace of SVG elements.
pub const SVG: &str = "http://www.w3.org/2000/svg";
/// The namespace of `inkscape:label`.
pub const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
/// The namespace of `xlink:href`.
pub const XLINK: &str = "http://www.w3.org/1999/xlink";

/// The tree of `text`, whose root is an `svg` element.
pub fn parse<'a>(text: &'a str, file: &Arc<str>) -> Result<Document<'a>, Diagnostic> {
    if text.trim_start_matches('\u{feff}').trim().is_empty() {
        return Err(
            Diagnostic::error("the drawing is an empty file").at(Span::File(file.clone()), "")
        );
    }
    guard::check(text, file)?;
    let options = ParsingOptions {
        allow_dtd: true,
        nodes_limit: guard::MOST_NODES,
        entity_resolver: None,
    };
    let document =
        Document::parse_with_options(text, options).map_err(|e| broken(text, file, &e))?;
    let root = document.root_element();
    if name(root) != Some("svg") {
        let start = root.range().start;
        let end = start + 1 + root.tag_name().name().len();
        let span = Span::Bytes {
            file: file.clone(),
            start,
            end,
        };
        return Err(
            Diagnostic::error("the drawing is not an SVG: its root element is not `svg`")
                .at(span, ""),
        );
    }
    Ok(document)
}

/// The name of an SVG element; none for elements of other namespaces. A drawing that forgets to
/// declare the namespace is read all the same.
pub fn name<'a>(node: Node<'_, 'a>) -> Option<&'a str> {
    let tag = node.tag_name();
    (node.is_element() && matches!(tag.namespace(), None | Some(SVG))).then(|| tag.name())
}

/// See [`super::decode`].
pub fn decode<'a>(bytes: &'a [u8], file: &Arc<str>) -> Result<&'a str, Diagnostic> {
    let whole = || Span::File(file.clone());
    if bytes.starts_with(&[0x1f, 0x8b]) {
        let d = Diagnostic::error("the drawing is compressed (svgz)").at(whole(), "");
        return Err(d.help("save it as plain SVG"));
    }
    if bytes.starts_with(&[0xff, 0xfe])
        || bytes.starts_with(&[0xfe, 0xff])
        || bytes.starts_with(b"<\0")
    {
        return Err(Diagnostic::error("the drawing is UTF-16")
            .at(whole(), "")
            .help("save it as UTF-8"));
    }
    std::str::from_utf8(bytes).map_err(|e| {
        let start = e.valid_up_to();
        // Where a text is shown, a replacement character stands for the byte.
        let end = start + char::REPLACEMENT_CHARACTER.len_utf8();
        Diagnostic::error(format!(
            "the drawing is not UTF-8: byte {:#04x} at offset {start}",
            bytes[start]
        ))
        .at(
            Span::Bytes {
                file: file.clone(),
                start,
                end,
            },
            "",
        )
        .help("save it as UTF-8")
    })
}

fn broken(text: &str, file: &Arc<str>, error: &roxmltree::Error) -> Diagnostic {
    use roxmltree::Error as E;
    let (start, message) = match error {
        E::UnexpectedEndOfStream => (text.len(), "the file ends too early".to_string()),
        E::UnclosedRootNode => (text.len(), "the root element is not closed".to_string()),
        E::NodesLimitReached => (0, format!("it has more than {} nodes", guard::MOST_NODES)),
        other => {
            // The message ends in ` at LINE:COLUMN`, which the span says already.
            let message = other.to_string();
            let place = format!(" at {}", other.pos());
            (offset(text, other.pos()), message.replacen(&place, "", 1))
        }
    };
    let end = text[start..]
        .chars()
        .next()
        .map_or(start, |c| start + c.len_utf8());
    let span = Span::Bytes {
        file: file.clone(),
        start,
        end,
    };
    let diagnostic =
        Diagnostic::error(format!("the drawing is not well-formed XML: {message}")).at(span, "");
    match error {
        E::UnknownNamespace(prefix, _) => diagnostic.help(format!(
            "declare it in the root element: xmlns:{prefix}=\"…\""
        )),
        _ => diagnostic,
    }
}

/// The byte that a line and a column (in characters) name; the end of the text at most.
fn offset(text: &str, at: TextPos) -> usize {
    let line_start = match at.row {
        0 | 1 => 0,
        row => text
            .match_indices('\n')
            .nth(row as usize - 2)
            .map_or(text.len(), |(i, _)| i + 1),
    };
    let line = &text[line_start..];
    line.char_indices()
        .nth((at.col as usize).saturating_sub(1))
        .map_or(text.len(), |(i, _)| line_start + i)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> (String, usize) {
        let d = parse(text, &"a.svg".into()).unwrap_err();
        let Span::Bytes { start, .. } = d.labels[0].span else {
            panic!("no bytes in {d:?}")
        };
        (d.message, start)
    }

    #[test]
    fn broken_xml_is_located() {
        let (text, start) = message("<svg>\n<gä></gö>\n</svg>");
        assert_eq!(start, 11);
        assert!(text.contains("expected 'gä' tag, not 'gö'"), "{text}");
        assert_eq!(message("<svg><g>").1, 8);
        assert_eq!(
            message("<html/>"),
            (
                "the drawing is not an SVG: its root element is not `svg`".into(),
                0
            )
        );
        assert_eq!(
            parse(" ", &"a.svg".into()).unwrap_err().message,
            "the drawing is an empty file"
        );
    }

    #[test]
    fn only_utf8_is_text() {
        let file: Arc<str> = "a.svg".into();
        let utf16: Vec<u8> = "<svg/>".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert!(
            decode(&utf16, &file)
                .unwrap_err()
                .message
                .contains("UTF-16")
        );
        assert!(
            decode(&[0x1f, 0x8b, 8], &file)
                .unwrap_err()
                .message
                .contains("svgz")
        );
        assert!(
            decode(b"<svg id='\xe9'/>", &file)
                .unwrap_err()
                .message
                .contains("offset 9")
        );
        let marked = decode(b"\xef\xbb\xbf<svg/>", &file).unwrap();
        assert!(parse(marked, &file).is_ok());
    }

    #[test]
    fn deep_nesting_parses_without_recursion() {
        let text = format!(
            "<svg>{}{}</svg>",
            "<g>".repeat(100_000),
            "</g>".repeat(100_000)
        );
        assert!(parse(&text, &"a.svg".into()).is_ok());
    }
}
