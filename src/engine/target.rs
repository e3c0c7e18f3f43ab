//! The artifacts of a spec as jobs: one per file, also where one entry stands for several.

use std::sync::Arc;

use super::compile::output_folder;
use super::database::{Db, SourceFile};
use super::job::Job;
use super::program::{Located, entry, program};
use super::scope::{evaluate_tree, scope};
use super::settings::Settings;
use super::target_paths::{collisions, reserved};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_graph::NodeId;
use fretwork_language::DecodeContext;
use fretwork_language::kinds::artifacts::Format;
use fretwork_language::{Entry, Section, Tree};

/// A file to make.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Its path below the output folder.
    pub path: String,
    /// The job that gives its bytes.
    pub job: Job,
    /// The place of its entry.
    pub span: Span,
}

/// The files that the artifacts of a spec stand for, in order of their entries, and what is wrong
/// with their paths.
pub fn targets(
    db: &dyn Db,
    root: SourceFile,
    settings: &Settings,
) -> (Vec<Target>, Vec<Diagnostic>) {
    let (mut targets, mut diagnostics) = (Vec::new(), Vec::new());
    for (id, located) in program(db, root)
        .entries
        .iter()
        .filter(|(id, _)| id.section == Section::Artifacts)
    {
        let variants = variants(db, root, settings, located).unwrap_or_else(|more| {
            diagnostics.extend(more);
            Vec::new()
        });
        for variant in variants {
            match target(db, root, settings, variant, (id, located)) {
                Ok(target) => targets.push(target),
                Err(more) => diagnostics.extend(more),
            }
        }
    }
    diagnostics.extend(collisions(&targets));
    diagnostics.extend(targets.iter().filter_map(reserved));
    (targets, diagnostics)
}

/// The file that an artifact's entry stands for with some values of `each`.
///
/// # Errors
/// When a value does not fit, or the path is wrong.
fn target(
    db: &dyn Db,
    root: SourceFile,
    settings: &Settings,
    variant: Vec<(Arc<str>, Tree)>,
    (id, located): (&NodeId, &Located<Entry>),
) -> Result<Target, Vec<Diagnostic>> {
    let known = &scope(db, root, settings.clone()).diagnostics;
    let settings = match variant.is_empty() {
        true => settings.clone(),
        false => settings.with(variant),
    };
    let scope = scope(db, root, settings.clone());
    let each = [&located.item.path()[..], &["each".into()]].concat();
    let each = Span::key(&located.file, &each);
    let wrong = scope.diagnostics.iter().filter(|d| !known.contains(d));
    let wrong: Vec<Diagnostic> = wrong
        .map(|d| d.clone().at(each.clone(), "with a value from here"))
        .collect();
    if !wrong.is_empty() {
        return Err(wrong);
    }
    let path = path(db, root, &settings, id, located)?;
    let job = Job {
        root,
        settings,
        node: id.clone(),
        region: None,
        window: None,
    };
    Ok(Target {
        path: format!("{}/{path}", output_folder(root.path(db))),
        job,
        span: located.span(),
    })
}

/// The values that an artifact's `each` gives to parameters, a list for every file.
fn variants(
    db: &dyn Db,
    root: SourceFile,
    settings: &Settings,
    located: &Located<Entry>,
) -> Result<Vec<Vec<(Arc<str>, Tree)>>, Vec<Diagnostic>> {
    let Some(each) = located.item.body.get("each") else {
        return Ok(vec![Vec::new()]);
    };
    let mut path = located.item.path();
    let context = DecodeContext {
        file: located.file.clone(),
        path: path.clone(),
        file_units: located.units,
        spec_units: program(db, root).measure(),
        is_scaled: false,
        modules: Default::default(),
    };
    path.push("each".into());
    let each = evaluate_tree(
        db,
        each,
        (&located.file, &path),
        &scope(db, root, settings.clone()),
    )?;
    fretwork_language::decode_each(&each, &context)
}

/// The format of an artifact; none when its path is wrong or has another extension. All that its
/// bytes depend on in the path: stands between the names of the scope and the stage.
#[salsa::tracked(returns(clone))]
pub fn format(db: &dyn Db, root: SourceFile, settings: Settings, id: NodeId) -> Option<Format> {
    let path = path(db, root, &settings, &id, &*entry(db, root, id.clone())?).ok()?;
    Format::of(&path)
}

/// The path of an artifact below its spec's folder, as its file says it: as [`format`], a firewall.
#[salsa::tracked(returns(clone))]
pub fn name(db: &dyn Db, root: SourceFile, settings: Settings, id: NodeId) -> Option<Arc<str>> {
    path(db, root, &settings, &id, &*entry(db, root, id.clone())?).ok()
}

/// The path of an artifact below its spec's folder, its expressions evaluated.
///
/// # Errors
/// When an expression fails, or the path leaves the folder.
fn path(
    db: &dyn Db,
    root: SourceFile,
    settings: &Settings,
    id: &NodeId,
    located: &Located<Entry>,
) -> Result<Arc<str>, Vec<Diagnostic>> {
    let scope = scope(db, root, settings.clone());
    let at = located.item.path();
    let span = || located.span();
    let name = evaluate_tree(
        db,
        &Tree::Text(id.name.clone()),
        (&located.file, &at),
        &scope,
    )
    .map_err(|mut diagnostics| {
        // The text with the expression is the key.
        diagnostics
            .iter_mut()
            .flat_map(|d| &mut d.labels)
            .for_each(|label| label.span = span());
        diagnostics
    })?;
    let Some(name) = name.to_text() else {
        return Err(vec![
            Diagnostic::error("the path of an artifact must be text").at(span(), ""),
        ]);
    };
    let parts: Vec<&str> = name.split('/').collect();
    let is_plain = |part: &&str| {
        !part.is_empty()
            && !part.starts_with('.')
            && !part.contains(|c: char| c.is_control() || "\\:".contains(c))
    };
    if !parts.iter().all(is_plain) {
        let message = format!("`{name}` is no path inside the output folder");
        return Err(vec![
            Diagnostic::error(message)
                .at(span(), "")
                .help("use names and `/`, without `..` and leading dots"),
        ]);
    }
    Ok(name)
}
