//! What the diagnostics of a stage are about, where no room below has said it: the sort of node and the file in
//! which the first place lies tell.

use fretwork_action::Definition;
use fretwork_diagnostic::{Code, Diagnostic, Span};
use fretwork_language::Section;

/// The diagnostics of a node, each with its code.
pub(super) fn coded(definition: &Definition, diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let section = definition.id.section;
    let one = |diagnostic: Diagnostic| {
        let code = code(section, &diagnostic);
        diagnostic.about(code)
    };
    diagnostics.into_iter().map(one).collect()
}

fn code(section: Section, diagnostic: &Diagnostic) -> Code {
    let files = diagnostic.labels.iter().map(|label| &label.span);
    let ends_with = |span: &Span, ending: &str| span.file().ends_with(ending);
    if files.clone().any(|span| ends_with(span, ".star")) {
        return Code::Script;
    }
    if files
        .clone()
        .any(|span| !ends_with(span, ".yaml") && !ends_with(span, ".yml"))
    {
        return Code::File;
    }
    match section {
        Section::Artifacts => Code::Format,
        Section::Bands | Section::Panels | Section::Shells | Section::Solids | Section::Facades => {
            Code::Synthesis
        }
        _ => Code::Value,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_room_that_knows_decides() {
        let at = |file: &str| Diagnostic::error("x").at(Span::File(file.into()), "");
        assert_eq!(code(Section::Bands, &at("a.yaml")), Code::Synthesis);
        assert_eq!(code(Section::Artifacts, &at("a.yaml")), Code::Format);
        assert_eq!(code(Section::Exemplars, &at("a.svg")), Code::File);
        assert_eq!(code(Section::Arrangements, &at("a.star")), Code::Script);
        assert_eq!(code(Section::Arrangements, &at("a.yaml")), Code::Value);
        assert_eq!(
            at("a.svg").about(Code::Output).about(Code::File).code,
            Some(Code::Output)
        );
    }
}
