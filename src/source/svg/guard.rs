//! Refuses texts that an XML parser would blow up on: its own limits leave quadratic ways out.

use std::collections::BTreeMap;
use std::sync::Arc;

use fretwork_diagnostic::{Diagnostic, Span};

/// The most nodes of a tree.
pub const MOST_NODES: u32 = 5_000_000;
const MOST_BYTES: usize = 64 << 20;
const MOST_ATTRIBUTES: usize = 10_000_000;
/// Attributes of one element are compared each with each.
const MOST_ATTRIBUTES_OF_ONE: usize = 20_000;
/// Every element that declares a namespace gets a copy of those around it.
const MOST_NAMESPACE_COPIES: usize = 50_000_000;
const MOST_ENTITIES: usize = 256;
const MOST_EXPANSION: usize = 64 << 20;
/// How deeply the parser lets entities refer to one another.
const ENTITY_DEPTH: usize = 10;

/// An error when the text is too large, or small but made to explode.
pub fn check(text: &str, file: &Arc<str>) -> Result<(), Diagnostic> {
    let refuse = |what: String| {
        let help = "drawings for fabrication are far smaller; simplify it or export it anew";
        Err(
            Diagnostic::error(format!("the drawing is too large: {what}"))
                .at(Span::File(file.clone()), "")
                .help(help),
        )
    };
    if text.len() > MOST_BYTES {
        return refuse(format!(
            "{} MB, the limit is {} MB",
            text.len() >> 20,
            MOST_BYTES >> 20
        ));
    }
    let counts = count(text.as_bytes());
    if counts.tags > MOST_NODES as usize || counts.equals > MOST_ATTRIBUTES {
        return refuse(format!(
            "more than {MOST_NODES} elements or {MOST_ATTRIBUTES} attributes"
        ));
    }
    if counts.in_one_tag > MOST_ATTRIBUTES_OF_ONE {
        return refuse(format!(
            "an element with more than {MOST_ATTRIBUTES_OF_ONE} attributes"
        ));
    }
    if counts.equals > 0 {
        let prefixes = text.matches("xmlns:").count();
        if prefixes.saturating_mul(text.matches("xmlns").count()) > MOST_NAMESPACE_COPIES {
            return refuse(format!("{prefixes} namespace declarations"));
        }
    }
    match expansion(text) {
        size if size > MOST_EXPANSION => refuse(format!(
            "its entities expand to more than {} MB",
            MOST_EXPANSION >> 20
        )),
        _ => Ok(()),
    }
}

#[derive(Default)]
struct Counts {
    tags: usize,
    equals: usize,
    /// The most values between one `<` and the next.
    in_one_tag: usize,
}

fn count(bytes: &[u8]) -> Counts {
    let mut counts = Counts::default();
    let mut values = 0;
    for (i, byte) in bytes.iter().enumerate() {
        match byte {
            b'<' => {
                counts.tags += 1;
                values = 0;
            }
            b'=' => {
                counts.equals += 1;
                values += usize::from(matches!(
                    bytes.get(i + 1),
                    Some(b'"' | b'\'' | b' ' | b'\n' | b'\t' | b'\r')
                ));
                counts.in_one_tag = counts.in_one_tag.max(values);
            }
            _ => {}
        }
    }
    counts
}

/// The size of all entity references when expanded; `usize::MAX` for too many entities.
fn expansion(text: &str) -> usize {
    let mut entities: BTreeMap<&str, (usize, Vec<&str>)> = BTreeMap::new();
    for (at, _) in text.match_indices("<!ENTITY") {
        let rest = text[at + "<!ENTITY".len()..].trim_start();
        let Some((name, rest)) = rest.split_once(char::is_whitespace) else {
            continue;
        };
        let rest = rest.trim_start();
        let Some(quote) = rest.chars().next().filter(|c| matches!(c, '"' | '\'')) else {
            continue;
        };
        let value = rest[1..].split(quote).next().unwrap_or("");
        entities
            .entry(name)
            .or_insert((value.len(), references(value).collect()));
        if entities.len() > MOST_ENTITIES {
            return usize::MAX;
        }
    }
    if entities.is_empty() {
        return 0;
    }
    let mut sizes: BTreeMap<&str, usize> = entities
        .iter()
        .map(|(name, (size, _))| (*name, *size))
        .collect();
    for _ in 0..ENTITY_DEPTH {
        let size_of = |name: &&str| sizes.get(name).copied().unwrap_or(0);
        let grown = |(size, inner): &(usize, Vec<&str>)| {
            inner.iter().map(size_of).fold(*size, usize::saturating_add)
        };
        sizes = entities
            .iter()
            .map(|(name, entity)| (*name, grown(entity)))
            .collect();
    }
    references(text)
        .map(|name| sizes.get(name).copied().unwrap_or(0))
        .fold(0, usize::saturating_add)
}

/// The names of the entities that `text` refers to.
fn references(text: &str) -> impl Iterator<Item = &str> {
    text.split('&').skip(1).filter_map(|rest| {
        let end = rest.bytes().take(100).position(|b| b == b';')?;
        Some(&rest[..end])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> Option<String> {
        check(text, &"a.svg".into()).err().map(|d| d.message)
    }

    #[test]
    fn entity_bombs_are_refused() {
        let quadratic = format!(
            "<!DOCTYPE svg [<!ENTITY a \"{}\">]><svg id=\"{}\"/>",
            "x".repeat(100_000),
            "&a;".repeat(1000)
        );
        assert!(refused(&quadratic).unwrap().contains("entities"));
        let mut laughs = String::from("<!DOCTYPE svg [<!ENTITY l0 \"lollollol\">");
        for i in 1..9 {
            laughs += &format!("<!ENTITY l{i} \"{}\">", format!("&l{};", i - 1).repeat(10));
        }
        assert!(
            refused(&(laughs + "]><svg id='&l8;'/>"))
                .unwrap()
                .contains("entities")
        );
        let many: String = (0..300).map(|i| format!("<!ENTITY e{i} \"x\">")).collect();
        assert!(refused(&format!("<!DOCTYPE svg [{many}]><svg/>")).is_some());
    }

    #[test]
    fn what_illustrator_writes_passes() {
        let text = "<!DOCTYPE svg PUBLIC \"-//W3C//DTD SVG 1.1//EN\" \"x.dtd\" [\n\t<!ENTITY ns_svg \"http://www.w3.org/2000/svg\">\n]>\
                    <svg xmlns=\"&ns_svg;\"/>";
        assert_eq!(refused(text), None);
    }

    #[test]
    fn attribute_and_namespace_floods_are_refused() {
        let attributes: String = (0..30_000).map(|i| format!(" a{i}=''")).collect();
        assert!(
            refused(&format!("<svg{attributes}/>"))
                .unwrap()
                .contains("attributes")
        );
        let namespaces: String = (0..10_000)
            .map(|i| format!("<g xmlns:n{i}='u{i}'>"))
            .collect();
        assert!(refused(&namespaces).unwrap().contains("namespace"));
    }
}
