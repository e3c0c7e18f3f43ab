//! Style sheets in the drawing: rules, nested or not, behind media queries or not. What is not
//! understood is left out and told; sheets in other files are told.
//!
//! ```text
//! block      text → declarations and blocks;  media: which of them are for screens
//! selector   which elements a rule is about
//! mod        the rules of all sheets, and those of one element, in order
//! ```

mod block;
mod media;
mod selector;

use std::collections::HashMap;
use std::rc::Rc;

use roxmltree::{Document, Node};

use super::document;
pub use block::{Declaration, declarations};
use block::{Part, declaration, parts, split_outside, without_comments};
use media::{Applies, applies};
use selector::{Key, Selector};

/// The deepest nesting of rules.
const DEEPEST: usize = 16;
/// The most selectors of all rules together, with those that nesting makes.
const MOST_SELECTORS: usize = 100_000;
/// The longest selector, in bytes.
const LONGEST: usize = 2000;

/// What was left out, and how the drawing can do without it.
pub type Unread = (String, &'static str);

const WITHOUT_RULES: &str = "its rules are left out; give the elements classes";
const WITHOUT_FILE: &str = "copy its rules into a `style` element of the drawing";

/// The rules of all sheets, found by what their selectors end in.
#[derive(Default)]
pub struct Sheet<'a> {
    rules: Vec<Rule<'a>>,
    ids: HashMap<String, Vec<usize>>,
    classes: HashMap<String, Vec<usize>>,
    tags: HashMap<String, Vec<usize>>,
    any: Vec<usize>,
    /// What is not understood and could matter to a drawing at rest.
    pub unread: Vec<Unread>,
}

struct Rule<'a> {
    selector: Rc<Selector>,
    body: Rc<Vec<Declaration<'a>>>,
}

/// The text of all `style` elements, without comments.
pub fn collect(document: &Document) -> String {
    let mut text = String::new();
    let styles = document.descendants();
    for node in styles.filter(|n| document::name(*n) == Some("style")) {
        let kind = node.attribute("type").unwrap_or("").trim();
        let is_css = kind.is_empty() || kind.to_ascii_lowercase().starts_with("text/css");
        if !is_css {
            continue;
        }
        let media = node.attribute("media").unwrap_or("");
        let whole: String = node.children().filter_map(|n| n.text()).collect();
        let bare = without_comments(&whole);
        if media.trim().is_empty() {
            text.push_str(&bare);
        } else {
            let media = media.replace(['{', '}', ';'], " ");
            text.push_str(&format!("@media {media} {{ {bare} }}"));
        }
        text.push('\n');
    }
    text
}

/// The sheets in other files that the document names.
pub fn linked(document: &Document) -> Vec<Unread> {
    let told = |file: &str| {
        let file: String = file.chars().take(80).collect();
        (
            format!("the style sheet `{file}` is not read"),
            WITHOUT_FILE,
        )
    };
    let instructions = document.root().children().filter_map(|n| n.pi());
    let sheets = instructions.filter(|pi| pi.target == "xml-stylesheet");
    let named = sheets.filter_map(|pi| {
        let value = pi.value.unwrap_or("");
        let is_used = quoted(value, "alternate") != Some("yes")
            && applies(quoted(value, "media").unwrap_or("")) != Applies::No;
        is_used.then(|| told(quoted(value, "href").unwrap_or("")))
    });
    let links = document.descendants().filter(|n| {
        n.tag_name().name() == "link"
            && n.attribute("rel")
                .is_some_and(|rel| rel.contains("stylesheet"))
    });
    named
        .chain(links.map(|n| told(n.attribute("href").unwrap_or(""))))
        .collect()
}

/// The value of a pseudo-attribute of a processing instruction.
fn quoted<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = text.split_once(name)?;
    let rest = rest.trim_start().strip_prefix('=')?.trim_start();
    let quote = rest.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    rest[1..].split(quote).next()
}

impl<'a> Sheet<'a> {
    /// The rules in `text`, which holds no comments.
    pub fn parse(text: &'a str) -> Sheet<'a> {
        let mut sheet = Sheet::default();
        sheet.add(text, &[], 0);
        sheet
    }

    /// The declarations for `node`, weakest first.
    pub fn declarations(&self, node: Node) -> impl Iterator<Item = Declaration<'a>> {
        let mut found: Vec<usize> = Vec::new();
        if !self.rules.is_empty() {
            let mut seek = |hits: Option<&Vec<usize>>| {
                let hits = hits.into_iter().flatten().copied();
                found.extend(hits.filter(|&i| self.rules[i].selector.matches(node)));
            };
            seek(Some(&self.any));
            seek(self.tags.get(node.tag_name().name()));
            seek(node.attribute("id").and_then(|id| self.ids.get(id)));
            let classes = node.attribute("class").unwrap_or("");
            for class in classes.split_whitespace() {
                seek(self.classes.get(class));
            }
        }
        found.sort_unstable_by_key(|&i| (self.rules[i].selector.specificity, i));
        found.dedup();
        found
            .into_iter()
            .flat_map(|i| self.rules[i].body.iter().cloned())
    }

    /// Adds what is in `text`: the top of a sheet, or the body of a rule for `parents`.
    ///
    /// Declarations before and after a nested rule are rules of their own there, so that what comes
    /// later wins (CSS Nesting, section 4).
    fn add(&mut self, text: &'a str, parents: &[String], depth: usize) {
        if depth > DEEPEST {
            let what = format!("rules nested more than {DEEPEST} deep are not read");
            return self.leave(what, WITHOUT_RULES);
        }
        let mut run = Vec::new();
        for part in parts(text) {
            match part {
                Part::Statement(text) if text.starts_with('@') => self.statement(text),
                Part::Statement(text) => run.extend(declaration(text)),
                Part::Block(prelude, body) => {
                    self.rule(parents, std::mem::take(&mut run));
                    if prelude.starts_with('@') {
                        self.group(prelude, body, parents, depth);
                    } else {
                        let selectors = self.nested(prelude, parents);
                        self.add(body, &selectors, depth + 1);
                    }
                }
            }
        }
        self.rule(parents, run);
    }

    /// An at-rule without a block.
    fn statement(&mut self, text: &str) {
        let lower = text.to_ascii_lowercase();
        if lower.starts_with("@import") {
            let file = text[7..].trim();
            let file = file.strip_prefix("url(").unwrap_or(file);
            let end = file.find([')', ' ']).unwrap_or(file.len());
            let file = file[..end].trim_matches(['"', '\'']);
            self.leave(
                format!("the style sheet `{file}` is not read"),
                WITHOUT_FILE,
            );
        } else if lower.starts_with("@layer") {
            self.leave(format!("`{text}` is not read"), WITHOUT_RULES);
        }
    }

    /// An at-rule with a block.
    fn group(&mut self, prelude: &'a str, body: &'a str, parents: &[String], depth: usize) {
        let end = prelude.find([' ', '(', '\n', '\t', '\r']);
        let (name, condition) = prelude.split_at(end.unwrap_or(prelude.len()));
        let name = name.to_ascii_lowercase();
        let answer = match name
            .trim_start_matches("@-webkit-")
            .trim_start_matches("@-moz-")
        {
            "@media" => applies(condition),
            "@font-face"
            | "keyframes"
            | "@keyframes"
            | "@page"
            | "@property"
            | "@counter-style"
            | "@font-feature-values"
            | "@font-palette-values"
            | "@color-profile"
            | "@view-transition" => Applies::No,
            _ => Applies::Unknown,
        };
        match answer {
            Applies::Yes => self.add(body, parents, depth + 1),
            Applies::No => {}
            Applies::Unknown => {
                let shown: String = prelude.chars().take(80).collect();
                self.leave(format!("`{shown}` is not read"), WITHOUT_RULES);
            }
        }
    }

    /// The selectors of a rule in the body of one for `parents`: each with each.
    fn nested(&mut self, prelude: &str, parents: &[String]) -> Vec<String> {
        let mut made = Vec::new();
        for text in split_outside(prelude, ',').map(str::trim) {
            if parents.is_empty() {
                made.push(text.to_string());
            }
            for parent in parents {
                match joined(parent, text) {
                    Some(selector) if selector.len() <= LONGEST => made.push(selector),
                    _ => self.misunderstood(text),
                }
            }
            if made.len() + self.rules.len() > MOST_SELECTORS {
                let what = format!("more than {MOST_SELECTORS} selectors are not read");
                self.leave(what, WITHOUT_RULES);
                return Vec::new();
            }
        }
        made
    }

    /// Adds one rule.
    fn rule(&mut self, selectors: &[String], body: Vec<Declaration<'a>>) {
        if body.is_empty() {
            return;
        }
        let body = Rc::new(body);
        for text in selectors {
            let Some(selector) = Selector::parse(text) else {
                self.misunderstood(text);
                continue;
            };
            let number = self.rules.len();
            match selector.key() {
                Key::Id(id) => self.ids.entry(id.into()).or_default().push(number),
                Key::Class(class) => self.classes.entry(class.into()).or_default().push(number),
                Key::Tag(tag) => self.tags.entry(tag.into()).or_default().push(number),
                Key::Any => self.any.push(number),
            }
            self.rules.push(Rule {
                selector: Rc::new(selector),
                body: body.clone(),
            });
        }
    }

    fn misunderstood(&mut self, selector: &str) {
        if !selector.is_empty() && !is_of_behaviour(selector) {
            let shown: String = selector.chars().take(80).collect();
            let what = format!("the selector `{shown}` is not understood");
            self.leave(what, WITHOUT_RULES);
        }
    }

    fn leave(&mut self, what: String, help: &'static str) {
        let unread = (what, help);
        if self.unread.len() < 20 && !self.unread.contains(&unread) {
            self.unread.push(unread);
        }
    }
}

/// The selector `nested` in the body of a rule for `parent`; none when it refers to it in a way that
/// is not understood.
fn joined(parent: &str, nested: &str) -> Option<String> {
    if nested.is_empty() {
        return None;
    }
    let Some(rest) = nested.strip_prefix('&') else {
        return (!nested.contains('&')).then(|| format!("{parent} {nested}"));
    };
    let is_word = rest.starts_with(|c: char| c.is_alphanumeric() || matches!(c, '_' | '-'));
    (!is_word && !rest.contains('&')).then(|| format!("{parent}{rest}"))
}

/// Whether a selector is about what a reader does with a page, or about generated content.
fn is_of_behaviour(selector: &str) -> bool {
    [
        "::", ":hover", ":focus", ":active", ":visited", ":link", ":target",
    ]
    .iter()
    .any(|word| selector.contains(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fill_of(css: &str, id: &str) -> String {
        let text = format!(
            "<svg><style>/* .a {{fill:comment}} */{}</style><g class='layer x' id='g'>\
             <path id='p' class='a b'/><g><rect id='r' data-kind='one two'/><rect id='s' lang='de-AT'/></g></g></svg>",
            css.replace('&', "&amp;")
        );
        let document = Document::parse(&text).unwrap();
        let css = collect(&document);
        let sheet = Sheet::parse(&css);
        let node = document
            .descendants()
            .find(|n| n.attribute("id") == Some(id))
            .unwrap();
        let found: Vec<_> = sheet
            .declarations(node)
            .filter(|d| d.name == "fill")
            .map(|d| d.value)
            .collect();
        found.join(" ")
    }

    fn unread(css: &str) -> Vec<String> {
        let sheet = Sheet::parse(css);
        sheet.unread.iter().map(|(what, _)| what.clone()).collect()
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
    fn selectors_match_by_attributes_and_siblings() {
        assert_eq!(
            fill_of(
                "[data-kind]{fill:1} rect[data-kind~='two']{fill:2} [data-kind='two']{fill:no}",
                "r"
            ),
            "1 2"
        );
        assert_eq!(fill_of("[lang|=de]{fill:1} [lang|=d]{fill:no}", "s"), "1");
        assert_eq!(
            fill_of(
                "rect+rect{fill:2} g>rect + [lang]{fill:3} path+rect{fill:no}",
                "s"
            ),
            "2 3"
        );
        assert_eq!(fill_of("rect:first-child{fill:1}", "r"), "1");
        assert_eq!(fill_of("rect:first-child{fill:1}", "s"), "");
    }

    #[test]
    fn rules_nest() {
        assert_eq!(fill_of("g{.a{fill:1} fill:no; >rect{fill:no}}", "p"), "1");
        assert_eq!(
            fill_of(
                "g{fill:0; & .a{fill:3} .a{fill:3} > .a{fill:4} &.layer{.b{fill:5}}}",
                "p"
            ),
            "3 3 4 5"
        );
        assert_eq!(fill_of("g{fill:1; .a{x:1} fill:2}", "g"), "1 2");
        assert_eq!(fill_of("#g,.x{@media screen{path{fill:1}}}", "p"), "1 1");
        assert_eq!(
            unread("a{.b &{fill:1}}"),
            ["the selector `.b &` is not understood"]
        );
        let deep = "g{".repeat(5000);
        assert_eq!(
            unread(&deep),
            ["rules nested more than 16 deep are not read"]
        );
        let wide = "g,g,g,g,g,g,g,g,g,g{".repeat(12) + "fill:red";
        assert!(unread(&wide)[0].starts_with("more than 100000 selectors"));
    }

    #[test]
    fn media_are_judged_and_what_is_not_known_is_told() {
        assert_eq!(
            fill_of(
                "@media screen{.a{fill:1}} @media print{.a{fill:no}} .a{fill:2}",
                "p"
            ),
            "1 2"
        );
        assert_eq!(
            unread(
                "@media (min-width: 3em) {.a{fill:1}} @supports (x:y){.b{fill:1}} @font-face{x:y}"
            ),
            [
                "`@media (min-width: 3em)` is not read",
                "`@supports (x:y)` is not read"
            ]
        );
        assert_eq!(
            unread("@import url('x.css') screen; @charset 'utf-8'; @layer a;"),
            [
                "the style sheet `x.css` is not read",
                "`@layer a` is not read"
            ]
        );
        let text =
            "<svg><style media='print'>a{fill:1}</style><style type='text/x'>b{}</style></svg>";
        let document = Document::parse(text).unwrap();
        let css = collect(&document);
        assert!(Sheet::parse(&css).rules.is_empty());
    }

    #[test]
    fn linked_sheets_are_told() {
        let text = "<?xml-stylesheet href=\"a.css\" type='text/css'?><?xml-stylesheet href='b.css' alternate='yes'?>\
            <?xml-stylesheet href='c.css' media='print'?><svg><link xmlns='http://www.w3.org/1999/xhtml' rel='stylesheet' href='d.css'/></svg>";
        let document = Document::parse(text).unwrap();
        let told: Vec<_> = linked(&document)
            .into_iter()
            .map(|(what, _)| what)
            .collect();
        assert_eq!(
            told,
            [
                "the style sheet `a.css` is not read",
                "the style sheet `d.css` is not read"
            ]
        );
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
                ".a:hover{fill:no} .a[x]{fill:no} .a~.b{fill:no} >.a{fill:no} .a>{fill:no} .{fill:no} .a{fill:1}",
                "p"
            ),
            "1"
        );
        assert_eq!(fill_of(".a{fill:1", "p"), "1");
        assert_eq!(fill_of("}{;,.a", "p"), "");
        assert_eq!(
            unread(".a:hover, .b, g:not(.c), a/b, a\\:b {x:y}"),
            [
                "the selector `g:not(.c)` is not understood",
                "the selector `a/b` is not understood",
                "the selector `a\\:b` is not understood"
            ]
        );
    }
}
