//! Whether an artifact's file can hold what it shows, known before anything is evaluated.

use super::database::Db;
use super::definition::definition;
use super::job::is_function_of_regions;
use super::program::entry;
use super::target::Target;
use fretwork_action::Definition;
use fretwork_diagnostic::{Code, Diagnostic, Span};
use fretwork_graph::NodeId;
use fretwork_language::kinds::artifacts::{Artifact, Content, Format};
use fretwork_language::{Node, Ref, ValueType, wants, with_article};

/// What is wrong with the file of `target`: a format that there is not or that cannot hold what is
/// shown, an arrangement without a region.
pub fn check_output(db: &dyn Db, target: &Target) -> Vec<Diagnostic> {
    let Some(format) = Format::of(&target.path) else {
        return vec![unknown_format(target)];
    };
    let Some(definition) = target.job.definition(db) else {
        return Vec::new();
    };
    let Node::Artifact(artifact) = &definition.node else {
        return Vec::new();
    };
    let mut diagnostics = Vec::new();
    let mut has_cutout = false;
    for (from, place) in shown(artifact) {
        let id = definition.target(from);
        let Some(node) =
            self::definition(db, target.job.root, target.job.settings.clone(), id.clone())
        else {
            continue;
        };
        let ty = node.node.provides();
        has_cutout |= ty == ValueType::Cutout;
        let span = || span(&definition, &place);
        if !format.accepts().contains(ty) {
            let message = format!("`{}` cannot show {}", target.path, with_article(ty.name()));
            let diagnostic = Diagnostic::error(message)
                .about(Code::Format)
                .at(span(), format!("`{id}` is {}", with_article(ty.name())));
            diagnostics.push(
                diagnostic.help(format!("the format holds: {}", format.accepts().describe())),
            );
        } else if (ty == ValueType::Field || is_function_of_regions(&node.node))
            && artifact.region.is_none()
        {
            diagnostics.push(without_region(target, id, ty).at(span(), "on which region?"));
        }
    }
    if format == Format::GeoJson && definition.map.is_none() {
        let message = format!("`{}` needs the plane of a map", target.path);
        let error = Diagnostic::error(message)
            .about(Code::Format)
            .at(target.span.clone(), "where on the ground?");
        diagnostics.push(error.help("add `map: {}` to the head of the spec"));
    }
    diagnostics.extend(without_effect(db, target, |name| {
        if !has_effect(name, format) {
            let extension = Format::EXTENSIONS[format as usize];
            Some(format!("not in a file of the format {extension}"))
        } else if name == "side" && !has_cutout {
            Some("nothing that it shows gets a thickness".to_owned())
        } else {
            None
        }
    }));
    diagnostics
}

/// The error of an artifact that shows a function and says nothing of where.
fn without_region(target: &Target, id: &NodeId, ty: ValueType) -> Diagnostic {
    let what = match ty {
        ValueType::Field => "the plane",
        _ => "regions",
    };
    let message = format!(
        "`{id}` is a function of {what}, and `{}` names no region",
        target.path
    );
    Diagnostic::error(message)
        .about(Code::Format)
        .help("add `region: NAME` to the artifact")
}

/// Warnings for fields of an artifact that nothing is made of, each with the `reason` for it.
fn without_effect(
    db: &dyn Db,
    target: &Target,
    reason: impl Fn(&str) -> Option<String>,
) -> Vec<Diagnostic> {
    let Some(entry) = entry(db, target.job.root, target.job.node.clone()) else {
        return Vec::new();
    };
    let names = [
        "region",
        "thickness",
        "side",
        "stroke",
        "draw",
        "crs",
        "clip",
        "optimize",
        "style",
        "kerf",
        "page",
        "margin",
        "width",
        "dpi",
        "view",
    ];
    let idle = names
        .into_iter()
        .filter(|name| entry.item.body.get(name).is_some())
        .filter_map(|name| Some((name, reason(name)?)));
    let warning = |(name, reason): (&str, String)| {
        let path: Vec<_> = entry.item.path().into_iter().chain([name.into()]).collect();
        Diagnostic::warning(format!("`{name}` has no effect in `{}`", target.path))
            .at(Span::key(&entry.file, &path), reason)
    };
    idle.map(warning).collect()
}

/// Whether the field `name` of an artifact can change a file of this format.
fn has_effect(name: &str, format: Format) -> bool {
    let is_drawing = matches!(format, Format::Svg | Format::Dxf | Format::Png);
    match name {
        "crs" => format == Format::GeoJson,
        "draw" | "clip" | "optimize" => is_drawing || format == Format::GeoJson,
        "region" => is_drawing || matches!(format, Format::Json | Format::GeoJson),
        "thickness" | "side" => !matches!(format, Format::Svg | Format::Dxf | Format::GeoJson),
        "width" | "view" | "dpi" => format == Format::Png,
        "page" | "margin" => matches!(format, Format::Svg | Format::Png),
        _ => is_drawing,
    }
}

fn unknown_format(target: &Target) -> Diagnostic {
    Diagnostic::error(format!("`{}` has the extension of no format", target.path))
        .about(Code::Format)
        .at(target.span.clone(), "")
        .help(format!("the formats are {}", Format::EXTENSIONS.join(", ")))
}

/// What an artifact shows, and where in its entry that is said.
fn shown(artifact: &Artifact) -> Vec<(&Ref<wants::Product>, Vec<String>)> {
    let of_part = |i: usize| vec!["parts".to_string(), i.to_string(), "from".to_string()];
    match &artifact.content {
        Content::From(from) => vec![(from, vec!["from".to_string()])],
        Content::Parts(parts) => parts
            .iter()
            .enumerate()
            .map(|(i, part)| (&part.from, of_part(i)))
            .collect(),
    }
}

fn span(definition: &Definition, place: &[String]) -> Span {
    let entry = [
        definition.id.section.name().into(),
        definition.id.name.clone(),
    ];
    let path: Vec<_> = entry
        .into_iter()
        .chain(place.iter().map(|step| step.as_str().into()))
        .collect();
    Span::value(&definition.file, &path)
}
