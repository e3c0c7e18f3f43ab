//! Style sheets in the drawing: rules with type, class and id selectors, joined by descent (`a b`)
//! and parentage (`a > b`). Rules with other selectors are left out and told; at-rules are skipped.

use std::collections::HashMap;

use roxmltree::{Document, Node};

use super::document;

/// How far up an ancestor is sought.
const MOST_ANCESTORS: usize = 256;

/// The rules of all sheets, found by what their selectors end in.
#[derive(Default)]
pub struct Sheet<'a> {
    rules: Vec<Rule<'a>>,
    by_key: HashMap<Key<'a>, Vec<usize>>,
    /// Selectors that are not understood and could match a drawing at rest.
    pub unread: Vec<&'a str>,
}

/// One `name: value`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Declaration<'a> {
    /// In lower case in all sheets that programs write; compared as it is.
    pub name: &'a str,
    /// Trimmed, without `!important`.
    pub value: &'a str,
    /// Whether it wins over all that are not.
    pub important: bool,
}

#[derive(Clone, PartialEq, Eq, Hash)]
enum Key<'a> {
    Id(&'a str),
    Class(&'a str),
    Tag(&'a str),
    Any,
}

struct Rule<'a> {
    selector: Selector<'a>,
    body: std::rc::Rc<Vec<Declaration<'a>>>,
}

/// From the element outward: a chain of parents, then above it another one somewhere, and so on.
struct Selector<'a> {
    chains: Vec<Vec<Compound<'a>>>,
    specificity: (usize, usize, usize),
}

#[derive(Default)]
struct Compound<'a> {
    tag: Option<&'a str>,
    id: Option<&'a str>,
    classes: Vec<&'a str>,
}

/// The text of all `style` elements, without comments.
pub fn collect(document: &Document) -> String {
    let mut text = String::new();
    for node in document
        .descendants()
        .filter(|n| document::name(*n) == Some("style"))
    {
        if matches!(node.attribute("type"), None | Some("" | "text/css")) {
            for part in node.children().filter_map(|n| n.text()) {
                text.push_str(part);
            }
            text.push('\n');
        }
    }
    let mut bare = String::with_capacity(text.len());
    let mut rest = text.as_str();
    while let Some((before, after)) = rest.split_once("/*") {
        bare.push_str(before);
        bare.push(' ');
        rest = after.split_once("*/").map_or("", |(_, tail)| tail);
    }
    bare.push_str(rest);
    bare
}

impl<'a> Sheet<'a> {
    /// The rules in `text`, which holds no comments.
    pub fn parse(text: &'a str) -> Sheet<'a> {
        let mut sheet = Sheet::default();
        let mut rest = text.trim_start();
        while !rest.is_empty() {
            rest = if rest.starts_with('@') {
                skip_at_rule(rest)
            } else {
                sheet.rule(rest)
            }
            .trim_start();
        }
        sheet
    }

    /// The declarations for `node`, weakest first.
    pub fn declarations(&self, node: Node, tag: &str) -> impl Iterator<Item = Declaration<'a>> {
        let mut found: Vec<usize> = Vec::new();
        if !self.rules.is_empty() {
            let mut seek = |key: Key| {
                let hits = self.by_key.get(&key).into_iter().flatten().copied();
                found.extend(hits.filter(|&i| self.rules[i].selector.matches(node)));
            };
            seek(Key::Any);
            seek(Key::Tag(tag));
            node.attribute("id")
                .into_iter()
                .for_each(|id| seek(Key::Id(id)));
            node.attribute("class")
                .into_iter()
                .flat_map(str::split_whitespace)
                .for_each(|c| seek(Key::Class(c)));
        }
        found.sort_unstable_by_key(|&i| (self.rules[i].selector.specificity, i));
        found.dedup();
        found
            .into_iter()
            .flat_map(|i| self.rules[i].body.iter().copied())
    }

    /// Takes one rule off `text` and gives what follows.
    fn rule(&mut self, text: &'a str) -> &'a str {
        let Some((prelude, rest)) = text.split_once('{') else {
            return "";
        };
        let (body, rest) = rest.split_once('}').unwrap_or((rest, ""));
        let body = std::rc::Rc::new(declarations(body).collect::<Vec<_>>());
        for text in prelude.split(',').map(str::trim) {
            let Some(selector) = selector(text) else {
                self.unread
                    .extend(Some(text).filter(|text| !text.is_empty() && !is_of_behaviour(text)));
                continue;
            };
            let last = &selector.chains[0][0];
            let key = match (last.id, last.classes.first(), last.tag) {
                (Some(id), _, _) => Key::Id(id),
                (None, Some(class), _) => Key::Class(class),
                (None, None, Some(tag)) => Key::Tag(tag),
                (None, None, None) => Key::Any,
            };
            self.by_key.entry(key).or_default().push(self.rules.len());
            self.rules.push(Rule {
                selector,
                body: body.clone(),
            });
        }
        rest
    }
}

/// Whether a selector is about what a reader does with a page, or about generated content.
fn is_of_behaviour(selector: &str) -> bool {
    [
        "::", ":hover", ":focus", ":active", ":visited", ":link", ":target",
    ]
    .iter()
    .any(|word| selector.contains(word))
}

/// The declarations of a `style` attribute or of a rule's body.
pub fn declarations(text: &str) -> impl Iterator<Item = Declaration<'_>> {
    split_outside(text, ';').filter_map(|part| {
        let (name, value) = part.split_once(':')?;
        let value = value.trim();
        let (bare, important) = match value.rsplit_once('!') {
            Some((bare, word)) if word.trim().eq_ignore_ascii_case("important") => {
                (bare.trim_end(), true)
            }
            _ => (value, false),
        };
        Some(Declaration {
            name: name.trim(),
            value: bare,
            important,
        })
    })
}

/// The parts of `text` between separators that stand outside quotes and parentheses.
fn split_outside(text: &str, separator: char) -> impl Iterator<Item = &str> {
    let (mut depth, mut quote) = (0usize, None);
    text.split(move |c: char| {
        match (quote, c) {
            (Some(q), _) if c == q => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '(') => depth += 1,
            (None, ')') => depth = depth.saturating_sub(1),
            _ => return c == separator && depth == 0,
        }
        false
    })
}

fn skip_at_rule(text: &str) -> &str {
    let mut depth = 0usize;
    for (i, c) in text.char_indices() {
        match c {
            ';' if depth == 0 => return &text[i + 1..],
            '{' => depth += 1,
            '}' if depth <= 1 => return &text[i + 1..],
            '}' => depth -= 1,
            _ => {}
        }
    }
    ""
}

fn selector(text: &str) -> Option<Selector<'_>> {
    let mut chains: Vec<Vec<Compound>> = Vec::new();
    let mut child = false;
    let spaced: Vec<&str> = text
        .split_whitespace()
        .flat_map(|word| word.split_inclusive('>'))
        .collect();
    for word in spaced {
        let (bare, parent) = word
            .strip_suffix('>')
            .map_or((word, false), |bare| (bare, true));
        if !bare.is_empty() {
            let compound = compound(bare)?;
            match chains.last_mut() {
                Some(chain) if child => chain.push(compound),
                _ => chains.push(vec![compound]),
            }
            child = false;
        }
        if parent && (child || chains.is_empty()) {
            return None;
        }
        child |= parent;
    }
    if chains.is_empty() || child {
        return None;
    }
    chains.reverse();
    chains.iter_mut().for_each(|chain| chain.reverse());
    let all = || chains.iter().flatten();
    let specificity = (
        all().filter(|c| c.id.is_some()).count(),
        all().map(|c| c.classes.len()).sum(),
        all().filter(|c| c.tag.is_some()).count(),
    );
    Some(Selector {
        chains,
        specificity,
    })
}

fn compound(text: &str) -> Option<Compound<'_>> {
    if text.contains([':', '[', '+', '~', '\\', '"']) {
        return None;
    }
    let mut compound = Compound::default();
    let mut rest = text;
    let head = rest.find(['.', '#']).unwrap_or(rest.len());
    compound.tag = Some(&rest[..head]).filter(|tag| !tag.is_empty() && *tag != "*");
    rest = &rest[head..];
    while !rest.is_empty() {
        let end = rest[1..].find(['.', '#']).map_or(rest.len(), |i| i + 1);
        let name = Some(&rest[1..end]).filter(|name| !name.is_empty())?;
        if rest.starts_with('.') {
            compound.classes.push(name);
        } else if compound.id.replace(name).is_some() {
            return None;
        }
        rest = &rest[end..];
    }
    Some(compound)
}

impl Selector<'_> {
    fn matches(&self, node: Node) -> bool {
        let Some(mut top) = chain_top(&self.chains[0], node) else {
            return false;
        };
        for chain in &self.chains[1..] {
            // The nearest ancestor that fits leaves the most room for those above.
            let found = top
                .ancestors()
                .skip(1)
                .take(MOST_ANCESTORS)
                .find_map(|n| chain_top(chain, n));
            let Some(next) = found else { return false };
            top = next;
        }
        true
    }
}

/// The uppermost element of the chain of parents that ends in `node`, if it fits.
fn chain_top<'a, 'input>(chain: &[Compound], node: Node<'a, 'input>) -> Option<Node<'a, 'input>> {
    let mut at = node;
    for (i, compound) in chain.iter().enumerate() {
        if i > 0 {
            at = at.parent_element()?;
        }
        if !compound.matches(at) {
            return None;
        }
    }
    Some(at)
}

impl Compound<'_> {
    fn matches(&self, node: Node) -> bool {
        let has_class = |class: &&str| {
            node.attribute("class")
                .is_some_and(|all| all.split_whitespace().any(|c| c == *class))
        };
        node.is_element()
            && self.tag.is_none_or(|tag| document::name(node) == Some(tag))
            && self.id.is_none_or(|id| node.attribute("id") == Some(id))
            && self.classes.iter().all(has_class)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fill_of(css: &str, id: &str) -> String {
        let text = format!(
            "<svg><style>/* .a {{fill:comment}} */{css}</style><g class='layer x' id='g'>\
             <path id='p' class='a b'/><g><rect id='r'/></g></g></svg>"
        );
        let document = Document::parse(&text).unwrap();
        let css = collect(&document);
        let sheet = Sheet::parse(&css);
        let node = document
            .descendants()
            .find(|n| n.attribute("id") == Some(id))
            .unwrap();
        let tag = node.tag_name().name();
        let found: Vec<_> = sheet
            .declarations(node, tag)
            .filter(|d| d.name == "fill")
            .map(|d| d.value)
            .collect();
        found.join(" ")
    }

    #[test]
    fn selectors_match_by_type_class_id_and_place() {
        assert_eq!(
            fill_of("path{fill:1} .a{fill:2} #p{fill:3} *{fill:0}", "p"),
            "0 1 2 3"
        );
        assert_eq!(
            fill_of(
                ".b.a{fill:2} .a{fill:1} path.a.c{fill:no} rect{fill:no}",
                "p"
            ),
            "1 2"
        );
        assert_eq!(
            fill_of("g rect{fill:1} g>rect{fill:3} svg rect {fill:2}", "r"),
            "1 3 2"
        );
        assert_eq!(
            fill_of(
                ".layer > g > rect{fill:1} .layer > rect{fill:no} #g g rect{fill:2}",
                "r"
            ),
            "1 2"
        );
        assert_eq!(fill_of("path, rect{fill:1}", "p"), "1");
    }

    #[test]
    fn what_is_not_understood_is_left_out() {
        assert_eq!(
            fill_of(
                "@import url(x.css); @media print{ .a{fill:no} } .a{fill:1}",
                "p"
            ),
            "1"
        );
        assert_eq!(
            fill_of(
                ".a:hover{fill:no} .a[x]{fill:no} .a+.b{fill:no} >.a{fill:no} .a>{fill:no} .{fill:no} .a{fill:1}",
                "p"
            ),
            "1"
        );
        assert_eq!(fill_of(".a{fill:1", "p"), "1");
        assert_eq!(fill_of("}{;,.a", "p"), "");
        let sheet = Sheet::parse(".a:hover, .b, g:not(.c) {} [x] {}");
        assert_eq!(sheet.unread, ["g:not(.c)", "[x]"]);
    }

    #[test]
    fn declarations_split_outside_quotes_and_parentheses() {
        let found: Vec<_> =
            declarations("fill : url(a;b) ; x:'a;b';stroke:red ! IMPORTANT;;bad").collect();
        let plain = |name, value| Declaration {
            name,
            value,
            important: false,
        };
        let red = Declaration {
            name: "stroke",
            value: "red",
            important: true,
        };
        assert_eq!(found, [plain("fill", "url(a;b)"), plain("x", "'a;b'"), red]);
    }
}
