//! Mappers on all cores. Cells are taken in fixed chunks, each with an interpreter and heaps of its
//! own that are dropped when they have grown; results are put together in the order of the cells,
//! so that neither chunks nor threads can be seen in them.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use starlark::environment::{FrozenModule, Module};
use starlark::eval::Evaluator;
use starlark::values::{FrozenValue, Value};

use crate::patch::Patch;
use crate::script::mapping::{Collected, Mapping, map_cell};
use fretwork_geometry::budget::{self, Meter};
use fretwork_geometry::progress::Watcher;
use fretwork_geometry::{Curves, Point, Seed};
use fretwork_script::Limits;
use fretwork_script::fault::Fault;
use fretwork_script::known::KnownCells;
use fretwork_script::module::ScriptModule;
use fretwork_script::scope::{Scope, cell_seeds};
use fretwork_script::session::{Scale, Session, prepare, refuse, session};
use fretwork_script::values::Cell;
use fretwork_script::watch::Watch;

/// A heap is dropped when it is larger than this, in bytes, and curves of so many points hang on it.
const HEAP: usize = 2 << 20;
const POINTS: usize = 1 << 17;

/// Steps of the budget for a step of the interpreter, which is a call or a round of a loop.
const TICK: u64 = 4;

/// An evaluation that was started from outside, as its threads share it.
pub(crate) struct Job {
    pub script: Arc<ScriptModule>,
    /// Keeps alive what the entry gave.
    pub module: FrozenModule,
    pub scale: Scale,
    /// What mappers must not ask for.
    pub watch: Option<Watch>,
    /// What the planar maps that are mapped cover, where their results are to be repeated.
    pub patch: Option<Patch>,
    /// What of the map that is mapped is known, if not all of it.
    pub known: Option<Arc<KnownCells>>,
    /// Steps of all mapper calls so far.
    spent: AtomicU64,
    failed: Mutex<Option<Box<Fault>>>,
}

const UNPOISONED: &str = "no code panics while it holds the fault";

impl Job {
    pub fn new(script: Arc<ScriptModule>, module: FrozenModule, scale: Scale) -> Job {
        Job {
            script,
            module,
            scale,
            watch: None,
            patch: None,
            known: None,
            spent: AtomicU64::new(0),
            failed: Mutex::new(None),
        }
    }

    /// Keeps `fault` while the interpreter passes an error through that stands for it.
    pub fn stash(&self, fault: Box<Fault>) -> starlark::Error {
        let error = refuse(fault.message.clone());
        *self.failed.lock().expect(UNPOISONED) = Some(fault);
        error
    }

    /// The fault that was kept.
    pub fn stashed(&self) -> Option<Box<Fault>> {
        self.failed.lock().expect(UNPOISONED).take()
    }
}

/// What a chunk gives.
type Mapped = Result<Curves, Box<Fault>>;

/// The curves that `mapper` gives for the cells. A mapper that is frozen, as all are that exist
/// before the evaluation, is called on all cores where the evaluation is not itself part of such a
/// call; the result is the same.
pub(crate) fn map_cells<'v>(
    mapping: &Mapping,
    mapper: Value<'v>,
    eval: &mut Evaluator<'v, '_, '_>,
) -> starlark::Result<Curves> {
    let session = session(eval);
    if let (Some(job), Some(frozen)) = (session.job::<Job>(), mapper.unpack_frozen()) {
        return map_in_parallel(mapping, frozen, &job).map_err(|fault| job.stash(fault));
    }
    // A planar map lives until the mapper's call around it ends, and takes about as much memory.
    session.draw_points(4 * mapping.map.edge_count())?;
    let number = session.add_map(mapping.map.clone());
    let kinds = (cell_seeds(mapping.seed), mapping.reach);
    let mut out = Collected::up_to(Limits::MAPPER.points);
    for id in mapping.cells() {
        let cell = Cell {
            kind: mapping.kind,
            map: number,
            id,
        };
        let mapped = map_cell(mapper, cell, kinds, &mut out, eval);
        mapped.inspect_err(|_| session.note(mapping.note(mapper, cell)))?;
    }
    Ok(out.curves)
}

/// The curves that `mapper`, which lives in the module of `job`, gives for the cells of `mapping`.
pub(crate) fn map_in_parallel(mapping: &Mapping, mapper: FrozenValue, job: &Job) -> Mapped {
    let count = mapping.len();
    let size = (count / 32).clamp(1, 512);
    let chunks: Vec<Range<usize>> = (0..count)
        .step_by(size)
        .map(|from| from..(from + size).min(count))
        .collect();
    let results: Vec<Mutex<Option<Mapped>>> = chunks.iter().map(|_| Mutex::new(None)).collect();
    let (next, first_failed) = (AtomicUsize::new(0), AtomicUsize::new(usize::MAX));
    let watcher = Watcher::here();
    let work = || loop {
        let i = next.fetch_add(1, Ordering::Relaxed);
        // Chunks are begun in order, so that the first fault is the same for any number of threads.
        if i >= chunks.len() || i > first_failed.load(Ordering::Relaxed) {
            break;
        }
        watcher.step(|| format!("mapping cells, {} of {}", chunks[i].start, count));
        let result = map_chunk(mapping, mapper, job, chunks[i].clone());
        if result.is_err() {
            first_failed.fetch_min(i, Ordering::Relaxed);
        }
        *results[i].lock().expect(UNPOISONED) = Some(result);
    };
    let meter = Meter::current();
    let work = || meter.during(work);
    let threads = rayon::current_num_threads().min(chunks.len());
    if threads > 1 {
        rayon::scope(|scope| (0..threads).for_each(|_| scope.spawn(|_| work())));
    } else {
        work();
    }
    let mut out = Collected::up_to(Limits::RESULT);
    let results: Vec<Option<Mapped>> = results
        .into_iter()
        .map(|result| result.into_inner().expect(UNPOISONED))
        .collect();
    let points = results
        .iter()
        .flatten()
        .flatten()
        .map(|curves| curves.points().len());
    budget::make("points of curves", points.sum(), 2 * size_of::<Point>());
    for result in results {
        let Some(result) = result else { continue };
        out.append(&result?).map_err(|e| Fault::of(&e))?;
    }
    Ok(out.curves)
}

fn map_chunk(mapping: &Mapping, mapper: FrozenValue, job: &Job, items: Range<usize>) -> Mapped {
    let mut out = Collected::up_to(Limits::RESULT);
    let mut rest = items;
    while !rest.is_empty() {
        map_part(mapping, mapper, job, &mut rest, &mut out)?;
    }
    Ok(out.curves)
}

/// Maps cells from the front of `rest` until none is left or the heap has grown.
fn map_part(
    mapping: &Mapping,
    mapper: FrozenValue,
    job: &Job,
    rest: &mut Range<usize>,
    out: &mut Collected,
) -> Result<(), Box<Fault>> {
    Module::with_temp_heap(|module| {
        module.heap().add_reference(job.module.frozen_heap());
        let scope = Scope::entry(Seed::root(0));
        let session = Session::new(
            Limits::MAPPER.scaled(),
            job.script.library.clone(),
            scope,
            job.scale,
            None,
        )
        .watched(job.watch)
        .knowing(job.known.clone());
        let number = session.add_map(mapping.map.clone());
        let mut eval = Evaluator::new(&module);
        prepare(&mut eval, &session);
        let kinds = (cell_seeds(mapping.seed), mapping.reach);
        let mapper = mapper.to_value();
        let mut steps = 0;
        for n in rest.by_ref() {
            let (id, shift) = mapping.item(n);
            session.set_shift(shift);
            out.by = shift;
            let cell = Cell {
                kind: mapping.kind,
                map: number,
                id,
            };
            let before = eval.get_total_tick_count();
            if let Err(error) = map_cell(mapper, cell, kinds, out, &mut eval) {
                let mut fault = Fault::of(&error);
                fault.notes = session.take_notes();
                fault.notes.push(match job.watch {
                    // The cell stands for all of its copies, wherever it lies.
                    Some(_) => mapping.site_note(mapper),
                    None => mapping.note(mapper, cell),
                });
                return Err(fault);
            }
            let (charged, points) = session.used();
            steps += eval.get_total_tick_count() - before;
            session.forget_maps(1);
            let half = Limits::MAPPER.steps / 2;
            if steps + charged > half || points > POINTS || eval.heap().allocated_bytes() > HEAP {
                break;
            }
        }
        charge(job, steps + session.used().0)
    })
}

/// Charges the node and the evaluation for the steps of some calls.
fn charge(job: &Job, steps: u64) -> Result<(), Box<Fault>> {
    budget::spend("calls of mappers", TICK * steps);
    let all = job.spent.fetch_add(steps, Ordering::Relaxed);
    if all > Limits::EVALUATION {
        return Err(Fault::new(format!(
            "the evaluation takes more than {} steps",
            Limits::EVALUATION
        )));
    }
    Ok(())
}
