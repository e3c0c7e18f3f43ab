//! Every function is explained, with an example that compiles.

use std::sync::Arc;

use starlark::docs::{DocItem, DocMember};
use starlark::environment::GlobalsBuilder;

use super::Memory;
use crate::script::operators::GROUPS;
use crate::script::program::Script;
use crate::script::reference::functions_reference;

/// What the examples speak of.
const NAMES: &str = "leaf, knob, dot, face, edge, vertex, cells, blobs, rows, courses";

#[test]
fn every_function_is_explained_with_an_example_that_compiles() {
    let page = functions_reference();
    let mut count = 0;
    for (title, register) in GROUPS {
        for (name, item) in GlobalsBuilder::new()
            .with(register)
            .build()
            .documentation()
            .members
        {
            let DocItem::Member(DocMember::Function(function)) = item else {
                continue;
            };
            let docs = function
                .docs
                .unwrap_or_else(|| panic!("{name} has no docs"));
            let details = docs.details.unwrap_or_default();
            let example = details
                .split_once("Example: `")
                .and_then(|(_, rest)| rest.strip_suffix('`'))
                .unwrap_or_else(|| panic!("{name} of {title} has no example: {details}"));
            assert!(example.contains(&name), "{name}: {example}");
            assert!(
                details.contains("ail") || details.contains("nothing"),
                "{name}: {details}"
            );
            let text = format!("def entry({NAMES}):\n  {example}\n  return nothing()\n");
            let compiled = Script::compile(&"a.star".into(), &text, Arc::new(Memory::default()));
            assert!(compiled.is_ok(), "{name}: {:?}", compiled.err());
            assert!(page.contains(&format!("### `{name}(")));
            count += 1;
        }
    }
    assert!(count > 40, "{count}");
}
