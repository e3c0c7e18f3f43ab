//! Parameters of specs: what they are, and which of several specs a value is for.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::compile::Compiler;
use super::program::{Located, program};
use super::report::ParamReport;
use super::scope::setting_of;
use super::settings::Settings;
use fretwork_diagnostic::{Code, Diagnostic};
use fretwork_language::{Param, Tree};

impl Compiler {
    /// The settings of each of several specs, which are those of its own parameters, and an error for a
    /// name that is a parameter of none of them. One spec alone is told of its unknown names by
    /// [`Compiler::check`].
    pub fn settings_of(
        &self,
        specs: &[String],
        settings: &Settings,
    ) -> (Vec<Settings>, Vec<Diagnostic>) {
        if let [_] = specs {
            return (vec![settings.clone()], Vec::new());
        }
        let params: Vec<BTreeSet<Arc<str>>> = specs
            .iter()
            .map(|spec| {
                program(&self.database, self.root(spec))
                    .own_params()
                    .map(|p| p.item.name.clone())
                    .collect()
            })
            .collect();
        let each = params
            .iter()
            .map(|known| settings.only(|name| known.contains(name)))
            .collect();
        let known: BTreeSet<&Arc<str>> = params.iter().flatten().collect();
        let unknown = settings
            .entries()
            .filter(|(name, _)| !known.iter().any(|k| ***k == **name));
        let error = |(name, _)| {
            let error = Diagnostic::error(format!("no spec has a parameter `{name}`"))
                .about(Code::Reference);
            error.suggest(name, known.iter().map(|k| &***k))
        };
        (each, unknown.map(error).collect())
    }

    /// The parameters of a spec, and what is wrong with it under `settings`.
    pub fn params(&self, spec: &str, settings: &Settings) -> (Vec<ParamReport>, Vec<Diagnostic>) {
        (
            self.param_reports(spec, settings),
            self.check(spec, settings),
        )
    }

    /// The parameters of a spec and what they are under `settings`.
    pub fn param_reports(&self, spec: &str, settings: &Settings) -> Vec<ParamReport> {
        let program = program(&self.database, self.root(spec));
        let report = |located: &Located<Param>| {
            let p = &located.item;
            // A value that is refused is told as an error.
            let value = setting_of(located, settings).unwrap_or_else(|_| p.default.clone());
            ParamReport {
                name: p.name.to_string(),
                param_type: p.ty.word().to_string(),
                unit: p.ty.unit(located.units),
                value: value.to_json(),
                default: p.default.to_json(),
                min: p.min.as_ref().map(Tree::to_json),
                max: p.max.as_ref().map(Tree::to_json),
                choices: p.choices.iter().map(Tree::to_json).collect(),
                doc: p.doc.as_ref().map(ToString::to_string),
            }
        };
        program.own_params().map(report).collect()
    }
}
