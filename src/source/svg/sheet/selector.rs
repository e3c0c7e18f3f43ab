//! Selectors: types, classes, ids, attributes and first children, joined by descent (`a b`),
//! parentage (`a > b`) and succession (`a + b`).
//!
//! `simplecss` takes them apart. What it makes of them is not used: it matches by trying all
//! ancestors for each part, which a small drawing can make take for ever, and where it does not understand a
//! selector or a declaration it leaves out the rest of the rule without a word.

use roxmltree::Node;
use simplecss::{AttributeOperator, SelectorToken, SelectorTokenizer};

use super::super::document;

/// How far up an ancestor is sought.
const MOST_ANCESTORS: usize = 256;

/// From the element outward: a chain of parents and elder siblings, then above it another one somewhere, and so on.
pub struct Selector {
    chains: Vec<Vec<Compound>>,
    /// How many ids, classes and attributes, and types it names: the greater wins.
    pub specificity: (usize, usize, usize),
}

/// What a selector must have in common with an element at the least.
pub enum Key<'a> {
    /// This id.
    Id(&'a str),
    /// This class.
    Class(&'a str),
    /// This type.
    Tag(&'a str),
    /// Nothing.
    Any,
}

/// What is asked of one element, and where the next one inward is.
#[derive(Default)]
struct Compound {
    tag: Option<String>,
    id: Option<String>,
    classes: Vec<String>,
    attributes: Vec<(String, Option<(Operator, String)>)>,
    is_first: bool,
    /// Whether what is next inward is its younger sibling; else it is its child.
    is_elder: bool,
}

#[derive(Clone, Copy, PartialEq)]
enum Operator {
    Equals,
    HasWord,
    BeginsTag,
}

impl Selector {
    /// The selector that `text` is; none when it is not understood.
    pub fn parse(text: &str) -> Option<Selector> {
        // The tokenizer stops at these without an error.
        let is_bare = |c: char| matches!(c, '/' | '\\' | '{' | '}');
        if text.contains(is_bare) || super::block::split_outside(text, ',').count() > 1 {
            return None;
        }
        let mut chains: Vec<Vec<Compound>> = vec![vec![Compound::default()]];
        for token in SelectorTokenizer::from(text) {
            let chain = chains.last_mut()?;
            let last = chain.last_mut()?;
            match token.ok()? {
                SelectorToken::DescendantCombinator => chains.push(vec![Compound::default()]),
                SelectorToken::ChildCombinator => chain.push(Compound::default()),
                SelectorToken::AdjacentCombinator => {
                    last.is_elder = true;
                    chain.push(Compound::default());
                }
                token => last.ask(token)?,
            }
        }
        chains.reverse();
        chains.iter_mut().for_each(|chain| chain.reverse());
        let all = || chains.iter().flatten();
        let specificity = (
            all().filter(|c| c.id.is_some()).count(),
            all()
                .map(|c| c.classes.len() + c.attributes.len() + usize::from(c.is_first))
                .sum(),
            all().filter(|c| c.tag.is_some()).count(),
        );
        Some(Selector {
            chains,
            specificity,
        })
    }

    /// What the element must have.
    pub fn key(&self) -> Key<'_> {
        let last = &self.chains[0][0];
        match (&last.id, last.classes.first(), &last.tag) {
            (Some(id), _, _) => Key::Id(id),
            (None, Some(class), _) => Key::Class(class),
            (None, None, Some(tag)) => Key::Tag(tag),
            (None, None, None) => Key::Any,
        }
    }

    /// Whether it is about `node`. O(depth) for each part.
    pub fn matches(&self, node: Node) -> bool {
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

/// The outermost element of the chain that ends in `node`, if it fits.
fn chain_top<'a, 'input>(chain: &[Compound], node: Node<'a, 'input>) -> Option<Node<'a, 'input>> {
    let mut at = node;
    for (i, compound) in chain.iter().enumerate() {
        if i > 0 {
            at = match compound.is_elder {
                true => at.prev_sibling_element()?,
                false => at.parent_element()?,
            };
        }
        if !compound.matches(at) {
            return None;
        }
    }
    Some(at)
}

impl Compound {
    /// Asks for one thing more; none when that is not understood.
    fn ask(&mut self, token: SelectorToken) -> Option<()> {
        match token {
            SelectorToken::UniversalSelector => {}
            SelectorToken::TypeSelector(tag) => self.tag = Some(tag.into()),
            SelectorToken::ClassSelector(class) => self.classes.push(class.into()),
            SelectorToken::IdSelector(id) => {
                if self.id.replace(id.into()).is_some() {
                    return None;
                }
            }
            SelectorToken::AttributeSelector(name, operator) => {
                let asked = match operator {
                    AttributeOperator::Exists => None,
                    AttributeOperator::Matches(text) => Some((Operator::Equals, text.into())),
                    AttributeOperator::Contains(text) => Some((Operator::HasWord, text.into())),
                    AttributeOperator::StartsWith(text) => Some((Operator::BeginsTag, text.into())),
                };
                self.attributes.push((name.into(), asked));
            }
            SelectorToken::PseudoClass("first-child") => self.is_first = true,
            _ => return None,
        }
        Some(())
    }

    fn matches(&self, node: Node) -> bool {
        let has_class = |class: &String| {
            node.attribute("class")
                .is_some_and(|all| all.split_whitespace().any(|c| c == class))
        };
        let has_attribute = |(name, asked): &(String, Option<(Operator, String)>)| {
            let Some(value) = node.attribute(name.as_str()) else {
                return false;
            };
            match asked {
                None => true,
                Some((Operator::Equals, text)) => value == text,
                Some((Operator::HasWord, text)) => value.split_whitespace().any(|w| w == text),
                Some((Operator::BeginsTag, text)) => value
                    .strip_prefix(text.as_str())
                    .is_some_and(|rest| rest.is_empty() || rest.starts_with('-')),
            }
        };
        node.is_element()
            && self
                .tag
                .as_deref()
                .is_none_or(|tag| document::name(node) == Some(tag))
            && self
                .id
                .as_deref()
                .is_none_or(|id| node.attribute("id") == Some(id))
            && self.classes.iter().all(has_class)
            && self.attributes.iter().all(has_attribute)
            && (!self.is_first || node.prev_sibling_element().is_none())
    }
}
