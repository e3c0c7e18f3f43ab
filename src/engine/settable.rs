//! The parameters of a spec as they were when it was read, for callers that must answer while the compiler is at work: whether a
//! value would be taken, and what to tell where it would not.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use super::compile::Compiler;
use super::database::Db as _;
use super::program::{Located, program};
use super::scope::setting_of;
use super::settings::Settings;
use fretwork_diagnostic::render::Sources;
use fretwork_diagnostic::{Code, Diagnostic, Span};
use fretwork_language::{Param, Places};

/// Parameters and the texts that declare them.
#[derive(Clone, Debug, Default)]
pub struct Settable {
    params: Vec<Located<Param>>,
    texts: BTreeMap<Arc<str>, Arc<[u8]>>,
}

impl Compiler {
    /// The parameters of a spec, as it was last read.
    pub fn settable(&self, spec: &str) -> Settable {
        let program = program(&self.database, self.root(spec));
        let params: Vec<_> = program.own_params().cloned().collect();
        let text = |file: &Arc<str>| {
            let content = self.database.file(file).content(&self.database).as_ref();
            Some((file.clone(), content.ok()?.whole().ok()?))
        };
        let texts = params.iter().filter_map(|param| text(&param.file));
        Settable {
            texts: texts.collect(),
            params,
        }
    }
}

impl Settable {
    /// Whether there is a parameter of this name.
    pub fn has(&self, name: &str) -> bool {
        self.params.iter().any(|param| &*param.item.name == name)
    }

    /// What is wrong with `settings`: names that are no parameters, values of another type or beyond the limits.
    pub fn refusals(&self, settings: &Settings) -> Vec<Diagnostic> {
        let known = || self.params.iter().map(|param| &*param.item.name);
        let unknown = settings.entries().filter(|(name, _)| !self.has(name));
        let unknown = unknown.map(|(name, _)| {
            let error = Diagnostic::error(format!("the spec has no parameter `{name}`"));
            error.about(Code::Reference).suggest(name, known())
        });
        let refused = self.params.iter().filter_map(|param| {
            let problem = setting_of(param, settings).err()?;
            let name = &param.item.name;
            let error = Diagnostic::error(format!("parameter `{name}`: {problem}"));
            let span = Span::key(&param.file, &["params".into(), name.clone()]);
            Some(error.at(span, "declared here"))
        });
        unknown.chain(refused).collect()
    }
}

impl Sources for Settable {
    fn text(&self, file: &str) -> Option<Arc<str>> {
        let bytes = self.texts.get(file)?;
        Some(String::from_utf8_lossy(bytes).into())
    }

    fn locate(&self, span: &Span) -> Option<Range<usize>> {
        match span {
            Span::File(_) => Some(0..0),
            Span::Bytes { start, end, .. } => Some(*start..*end),
            Span::Name { file, path, key } => Places::new(self.text(file)?).locate(path, *key),
            Span::Text {
                file,
                path,
                start,
                end,
            } => Places::new(self.text(file)?).locate_text(path, *start..*end),
        }
    }
}
