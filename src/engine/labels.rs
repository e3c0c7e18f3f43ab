//! Labels that a spec asks for and that nothing can have, found without evaluating anything. Where a script or a drawing may
//! give a label nothing is said; a build looks at what there is.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::database::Db;
use super::definition::definition;
use super::job::{Job, shown};
use fretwork_action::Definition;
use fretwork_diagnostic::{Diagnostic, Span, nearest};
use fretwork_graph::NodeId;
use fretwork_language::kinds::arrangements::{
    Arrangement, Cells, ExtendedCells, Place, Projection, Relabel, ShownLines,
};
use fretwork_language::kinds::artifacts::Artifact;
use fretwork_language::kinds::partitions::{Partition, Stripes, Voronoi};
use fretwork_language::kinds::regions::{Faces, Region};
use fretwork_language::scalar::Label;
use fretwork_language::value::{LabelCycle, OneOrMany, WeightedLabels};
use fretwork_language::{Node, Ref, Wanted, wants};

/// Labels, and the names of nodes that stand for what has none.
type Labels = BTreeSet<Arc<str>>;

/// Warnings for the labels under `where` and `style` of a node that nothing can have.
pub fn idle_labels(db: &dyn Db, job: &Job) -> Vec<Diagnostic> {
    let Some(definition) = job.definition(db) else {
        return Vec::new();
    };
    let labels = Possible {
        db,
        job,
        definition: &definition,
    };
    match &definition.node {
        Node::Arrangement(Arrangement::Place(place)) => labels.of_place(place),
        Node::Arrangement(Arrangement::Relabel(relabel)) => labels.of_relabel(relabel),
        Node::Region(Region::Faces(faces)) => labels.of_faces(faces),
        Node::Artifact(artifact) => labels.of_styles(artifact),
        _ => Vec::new(),
    }
}

/// The labels that the inputs of one node can have.
struct Possible<'a> {
    db: &'a dyn Db,
    job: &'a Job,
    definition: &'a Definition,
}

impl Possible<'_> {
    fn of_place(&self, place: &Place) -> Vec<Diagnostic> {
        self.of_where(place.r#where.as_ref(), cells(&place.cells), "place")
    }

    fn of_relabel(&self, relabel: &Relabel) -> Vec<Diagnostic> {
        let Some(known) = self.labels(&relabel.from) else {
            return Vec::new();
        };
        let keys = relabel.labels.iter().map(|(key, _)| key);
        let unknown = keys.filter(|key| &***key != "*" && !known.contains(*key));
        let warning = |key: &Arc<str>| {
            let message = format!("nothing in `{}` is labelled `{key}`", relabel.from.name);
            let at = self.span(&["relabel", "labels", key]);
            advised(Diagnostic::warning(message).at(at, ""), key, &known)
        };
        unknown.map(warning).collect()
    }

    fn of_faces(&self, faces: &Faces) -> Vec<Diagnostic> {
        self.of_where(faces.r#where.as_ref(), &faces.of, "faces")
    }

    /// The labels under the `where` of a kind that cells of `of` cannot have.
    fn of_where(
        &self,
        wanted: Option<&OneOrMany<Label>>,
        of: &Ref<wants::Arrangement>,
        kind: &str,
    ) -> Vec<Diagnostic> {
        let (Some(wanted), Some(known)) = (wanted, self.labels(of)) else {
            return Vec::new();
        };
        let unknown = wanted.iter().filter(|label| !known.contains(&label.0));
        let warning = |label: &str| {
            let message = format!("nothing in `{}` is labelled `{label}`", of.name);
            advised(
                Diagnostic::warning(message).at(self.span(&[kind, "where"]), ""),
                label,
                &known,
            )
        };
        unknown.map(|label| warning(&label.0)).collect()
    }

    fn of_styles(&self, artifact: &Artifact) -> Vec<Diagnostic> {
        let mut known = Labels::new();
        for from in shown(artifact) {
            let Some(labels) = self.labels(from) else {
                return Vec::new();
            };
            known.extend(labels);
            known.insert(self.definition.target(from).name.clone());
        }
        let keys = artifact.style.iter().map(|(key, _)| key);
        let unknown = keys.filter(|key| &***key != "*" && !known.contains(*key));
        let warning = |key: &Arc<str>| {
            let message = format!("nothing that is drawn has the label or the name `{key}`");
            advised(
                Diagnostic::warning(message).at(self.span(&["style", key]), ""),
                key,
                &known,
            )
        };
        unknown.map(warning).collect()
    }

    /// The labels that the node behind a reference can have; none where they are not known.
    fn labels<T: Wanted>(&self, reference: &Ref<T>) -> Option<Labels> {
        labels(self.db, self.job, self.definition.target(reference))
    }

    /// The key at the end of a path in the entry.
    fn span(&self, path: &[&str]) -> Span {
        let id = &self.definition.id;
        let entry = [id.section.name(), id.own_name()].into_iter();
        let path: Vec<Arc<str>> = entry.chain(path.iter().copied()).map(Arc::from).collect();
        Span::key(&self.definition.file, &path)
    }
}

fn advised(warning: Diagnostic, label: &str, known: &Labels) -> Diagnostic {
    match nearest(label, known.iter().map(|known| &**known)) {
        Some(near) => warning.help(format!("did you mean `{near}`?")),
        None => warning,
    }
}

/// What labels a node of the spec of `job` can have. A union has those of all its parts; what comes of a script or a
/// drawing may have any.
fn labels(db: &dyn Db, job: &Job, id: &NodeId) -> Option<Labels> {
    let definition = definition(db, job.root, job.settings.clone(), id.clone())?;
    let of = |ids: &[&NodeId]| {
        ids.iter().try_fold(Labels::new(), |mut all, id| {
            all.extend(labels(db, job, id)?);
            Some(all)
        })
    };
    match &definition.node {
        Node::Region(Region::Faces(faces)) => of(&[definition.target(&faces.of)]),
        // The numbers of slices are known when there are some.
        Node::Region(Region::Slices(_)) => None,
        Node::Region(_) => Some(Labels::new()),
        Node::Partition(partition) => of_partition(partition),
        Node::Arrangement(arrangement) => match arrangement {
            Arrangement::Union(parts) => {
                let parts: Vec<&NodeId> =
                    parts.iter().map(|part| definition.target(part)).collect();
                of(&parts)
            }
            Arrangement::Transform(transform) => {
                let (ExtendedCells::Edges(input) | ExtendedCells::Faces(input)) = &transform.cells;
                of(&[definition.target(input)])
            }
            Arrangement::Fill(fill) => of(&[
                definition.target(&fill.faces),
                definition.target(&fill.with),
            ]),
            Arrangement::Repeat(repeat) => of(&[definition.target(&repeat.from)]),
            Arrangement::Relabel(relabel) => {
                let known = of(&[definition.target(&relabel.from)])?;
                Some(relabelled(relabel, known))
            }
            Arrangement::Projection(projection) => Some(of_projection(projection)),
            Arrangement::Registration(_) => {
                Some(["outline", "number"].into_iter().map(Arc::from).collect())
            }
            Arrangement::Inside(masked) | Arrangement::Outside(masked) => of(&[
                definition.target(&masked.input),
                definition.target(&masked.mask),
            ]),
            _ => None,
        },
        _ => None,
    }
}

fn relabelled(relabel: &Relabel, known: Labels) -> Labels {
    let find = |name: &str| relabel.labels.iter().find(|(key, _)| **key == *name);
    let new = |name: Arc<str>| match find(&name).or(find("*")) {
        Some((_, labels)) => labels.iter().map(|label| label.0.clone()).collect(),
        None => vec![name],
    };
    known.into_iter().flat_map(new).collect()
}

fn of_projection(projection: &Projection) -> Labels {
    let seen = ["border", "silhouette", "crease"];
    let hidden = (projection.lines == ShownLines::All).then_some("hidden");
    seen.into_iter().chain(hidden).map(Arc::from).collect()
}

fn of_partition(partition: &Partition) -> Option<Labels> {
    let cycle = |cycle: &LabelCycle| {
        let labels = cycle.0.iter().flatten();
        labels.map(|label| label.0.clone()).collect::<Vec<_>>()
    };
    let stripes =
        |stripes: &Stripes| [cycle(&stripes.edge_labels), cycle(&stripes.face_labels)].concat();
    let weighted = |labels: &WeightedLabels| {
        let labels = labels.0.iter();
        labels.map(|(label, _)| label.0.clone()).collect::<Vec<_>>()
    };
    let voronoi = |cells: &Voronoi| {
        let sets = [&cells.vertex_labels, &cells.edge_labels, &cells.face_labels];
        sets.map(weighted).concat()
    };
    let all = match partition {
        Partition::Stripes(one) => stripes(&one.lines),
        Partition::Grid(grid) => [stripes(&grid.across), stripes(&grid.along)].concat(),
        Partition::Uniform(cells) | Partition::Random(cells) => voronoi(cells),
        Partition::Packed(_) | Partition::Isolines(_) => return None,
    };
    Some(all.into_iter().collect())
}

fn cells(cells: &Cells) -> &Ref<wants::Arrangement> {
    match cells {
        Cells::Vertices(of) | Cells::Edges(of) | Cells::Faces(of) => of,
    }
}
