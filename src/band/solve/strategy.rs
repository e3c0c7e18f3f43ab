//! Which searches are made for a sequence, in which order.
//!
//! | strategy | when | what it gives |
//! | --- | --- | --- |
//! | dynamic programming without offsets | always | the cheapest sequence of all |
//! | A* within levels | the cheapest one drifts out of the band | a cheap one that stays |
//! | A* to settled ends | its final offsets leave the band | one whose last offset is near 0 |
//! | beam | patience ended first | one that stays, or the one that leaves the band least often |
//! | beam by autocorrelation | `variety` is asked for | one that repeats itself less |
//!
//! Offsets are not in the first table because most bands never need them, and 24 levels make a
//! table 24 times as large. When they are in, the table knows them only in levels, whose rounding
//! adds up along a sequence; hence the searches forward, which carry exact offsets and take from
//! the table what the rest costs at least.

use super::a_star::AStar;
use super::alignment::{accumulated_offsets, height};
use super::autocorrelation::Measure;
use super::beam::Beam;
use super::quantize::Tracked;
use super::quantized::Keep;
use super::search::Search;
use super::task::{Failure, Found, Problem, Rank, Sequence};

/// How many sequences A* goes on from, for every row of the table, in the first trial. With fewer
/// the beam has to help more often, which need not find the cheapest; with more, bands in which no
/// sequence stays take longer to say so.
const QUICK: usize = 8;
/// The same for the second trial, where the ends must settle and good sequences are rarer.
const LONG: usize = 64;
/// Widths of the beam where A* finds nothing that stays. The second is tried where the first loses
/// all sequences. A narrower beam loses them in more low bands; the time grows with the width.
const WIDTHS: [usize; 2] = [24, 120];
/// The width of the beam that weighs repetition. A narrow one keeps variants of one beginning and
/// loses those that pay off late; a wide one takes longer in proportion.
const VARIED_WIDTH: usize = 20;

/// What is asked: the cheapest sequence, or one that also repeats itself little.
///
/// # Errors
/// As for [`cheapest`].
pub fn solve(search: &Search) -> Result<Sequence, Failure> {
    let cheapest = cheapest(search, None)?.sequence;
    if search.problem.task.variety > 0.0 {
        Ok(varied(search, cheapest)?.sequence)
    } else {
        Ok(cheapest)
    }
}

/// The cheapest sequence. Where it leaves the band, the cheapest that is found of those that stay.
///
/// # Errors
/// `Impossible` where there is none, and also where none can be better than `rival`; `Drift` where
/// every sequence leaves the band.
pub fn cheapest(search: &Search, rival: Option<&Found>) -> Result<Found, Failure> {
    let Problem {
        pieces,
        seams,
        task,
    } = search.problem;
    let free = search.fill(Tracked::Nothing, Keep::Choices)?;
    let sequence = search.best(&free).ok_or(Failure::Impossible)?;
    let best_possible = Rank {
        leaves: false,
        value: sequence.cost,
    };
    if rival.is_some_and(|r| r.rank <= best_possible) {
        return Err(Failure::Impossible);
    }
    let accumulated = accumulated_offsets(seams, &sequence.pieces);
    let [below, above] = task.drift.beyond(&sequence.pieces, &accumulated);
    // No piece of a loop has to stand on the curve: the loop may be moved as a whole.
    let excess = if task.closed {
        0.5 * (below + above)
    } else {
        below.max(above)
    };
    if excess <= 0.0 {
        return Ok(Found {
            rank: search.rank(&sequence, sequence.cost),
            sequence,
        });
    }
    let least = height(pieces, &sequence.pieces, &accumulated, task.closed);
    within_band(search)?.ok_or(Failure::Drift(least))
}

/// The cheapest that is found of the sequences that stay in the band.
fn within_band(search: &Search) -> Result<Option<Found>, Failure> {
    let drift = &search.problem.task.drift;
    let (within, settled) = (Tracked::Within(drift), Tracked::Settled(drift));
    let stays = |found: &Option<Found>| found.as_ref().is_some_and(|f| !f.rank.leaves);
    let mut best = None;
    for (tracked, patience) in [(within, QUICK), (settled, LONG)] {
        if !stays(&best) {
            let table = &search.fill(tracked, Keep::Costs)?;
            let a_star = AStar {
                search,
                table,
                patience,
            };
            best = Found::better(best, a_star.run());
        }
    }
    for tracked in [settled, within] {
        if !stays(&best) {
            let table = &search.fill(tracked, Keep::Costs)?;
            let beam = |&width: &usize| {
                Beam {
                    search,
                    table,
                    measure: None,
                    width,
                }
                .run()
            };
            best = Found::better(best, WIDTHS.iter().find_map(beam));
        }
    }
    Ok(best)
}

/// A sequence that weighs repetition with the task's `variety` (section 3.7). It is the best of
/// those that the beam sees, and no worse than `cheapest` by the same measure. It need not be the
/// best of all: what is good now may repeat itself later (rule B6).
///
/// # Errors
/// As for filling a table.
pub fn varied(search: &Search, cheapest: Sequence) -> Result<Found, Failure> {
    let Problem { seams, task, .. } = search.problem;
    let measure = Measure::new(seams, task.variety);
    let beam = |tracked| -> Result<Option<Found>, Failure> {
        let table = &search.fill(tracked, Keep::Costs)?;
        let beam = Beam {
            search,
            table,
            measure: Some(&measure),
            width: VARIED_WIDTH,
        };
        Ok(beam.run())
    };
    let first = Found {
        rank: search.rank(&cheapest, measure.value(&cheapest, task.closed)),
        sequence: cheapest,
    };
    let mut best = Found::better(Some(first), beam(Tracked::Nothing)?);
    if best.as_ref().is_none_or(|found| found.rank.leaves) {
        best = Found::better(best, beam(Tracked::Settled(&task.drift))?);
    }
    best.ok_or(Failure::Impossible)
}
