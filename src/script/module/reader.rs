//! Reads a script and all that it loads, each file once and after those that it loads.

use std::collections::BTreeMap;
use std::sync::Arc;

use starlark::syntax::{AstModule, Dialect};

use crate::fault::Sources;
use crate::language;
use crate::library::Host;
use crate::module::definition::{Definition, functions};
use fretwork_diagnostic::{Code, Diagnostic, Span};

const DIALECT: Dialect = Dialect {
    enable_top_level_stmt: true,
    enable_keyword_only_arguments: true,
    ..Dialect::Standard
};

/// How many files a script may load, directly or not.
const FILES: usize = 200;

/// One file.
pub(crate) struct Unit {
    pub file: Arc<str>,
    pub ast: AstModule,
    /// Paths in its load statements, with the number of the unit.
    pub loads: Vec<(String, usize)>,
    /// Functions it defines, in order.
    pub functions: Vec<Definition>,
}

/// The files that were read so far.
pub(crate) struct Reader<'a> {
    host: &'a dyn Host,
    pub units: Vec<Unit>,
    known: BTreeMap<Arc<str>, usize>,
    pub sources: Sources,
}

impl<'a> Reader<'a> {
    /// A reader that has read nothing yet.
    pub fn new(host: &'a dyn Host) -> Reader<'a> {
        Reader {
            host,
            units: Vec::new(),
            known: BTreeMap::new(),
            sources: Sources::new(),
        }
    }

    /// Reads `file` after what it loads; its number. `open` are the files whose loads are being read.
    pub fn read(
        &mut self,
        file: &Arc<str>,
        text: &str,
        open: &mut Vec<Arc<str>>,
    ) -> Result<usize, Vec<Diagnostic>> {
        if let Some(number) = self.known.get(file) {
            return Ok(*number);
        }
        let place = |start: usize, end: usize| Span::Bytes {
            file: file.clone(),
            start,
            end,
        };
        let parsed = language::read(file, text, &DIALECT).map_err(|e| {
            vec![
                Diagnostic::error(e.message)
                    .about(Code::Script)
                    .at(place(e.start, e.end), ""),
            ]
        })?;
        open.push(file.clone());
        let mut loads = Vec::new();
        let mut errors = Vec::new();
        for load in parsed.plain.loads() {
            let (start, end) = (
                load.span.span.begin().get() as usize,
                load.span.span.end().get() as usize,
            );
            match self.load(load.module_id, file, open) {
                Ok(number) => loads.push((load.module_id.to_owned(), number)),
                Err(Failure::Here(message)) => errors.push(
                    Diagnostic::error(message)
                        .about(Code::Script)
                        .at(place(start, end), ""),
                ),
                Err(Failure::There(inner)) => errors.extend(inner),
            }
        }
        open.pop();
        if !errors.is_empty() {
            return Err(errors);
        }
        let functions = functions(parsed.plain.statement());
        self.sources.insert(file.to_string(), parsed.rewritten);
        self.units.push(Unit {
            file: file.clone(),
            ast: parsed.ast,
            loads,
            functions,
        });
        self.known.insert(file.clone(), self.units.len() - 1);
        Ok(self.units.len() - 1)
    }

    fn load(
        &mut self,
        path: &str,
        from: &Arc<str>,
        open: &mut Vec<Arc<str>>,
    ) -> Result<usize, Failure> {
        let (file, text) = self.host.script(path, from).map_err(Failure::Here)?;
        if let Some(first) = open.iter().position(|known| *known == file) {
            let mut circle: Vec<&str> = open[first..].iter().map(|f| &**f).collect();
            circle.push(&file);
            return Err(Failure::Here(format!(
                "scripts load one another in a circle: {}",
                circle.join(" → ")
            )));
        }
        if self.units.len() + open.len() > FILES {
            return Err(Failure::Here(format!(
                "more than {FILES} scripts are loaded"
            )));
        }
        self.read(&file, &text, open).map_err(Failure::There)
    }
}

/// Whether a load itself failed or the script that it loads.
enum Failure {
    Here(String),
    There(Vec<Diagnostic>),
}
