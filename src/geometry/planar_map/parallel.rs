//! Rows of a flat array, worked on in parallel. Which thread does what never shows in a result.

/// Below this many elements a task is not split.
const GRAIN: usize = 1 << 14;

/// Calls `work` with the number of every row and the row; row i is `data[starts[i]..starts[i + 1]]`. Each
/// task has a scratch value of its own.
pub(in crate::planar_map) fn for_each_row<T: Send, S: Default>(
    starts: &[u32],
    data: &mut [T],
    work: &(impl Fn(&mut S, usize, &mut [T]) + Sync),
) {
    fn split<T: Send, S: Default>(
        first: usize,
        starts: &[u32],
        data: &mut [T],
        work: &(impl Fn(&mut S, usize, &mut [T]) + Sync),
    ) {
        let rows = starts.len() - 1;
        if rows > 1 && data.len() > GRAIN {
            let middle = rows / 2;
            let (low, high) = data.split_at_mut((starts[middle] - starts[0]) as usize);
            rayon::join(
                || split(first, &starts[..=middle], low, work),
                || split(first + middle, &starts[middle..], high, work),
            );
            return;
        }
        let (mut scratch, mut rest) = (S::default(), data);
        for (i, w) in starts.windows(2).enumerate() {
            let (row, after) = rest.split_at_mut((w[1] - w[0]) as usize);
            work(&mut scratch, first + i, row);
            rest = after;
        }
    }
    if starts.len() > 1 {
        split(0, starts, data, work);
    }
}

/// `f` of every index below `count`, in order.
pub(in crate::planar_map) fn map<T: Send>(
    count: usize,
    f: impl Fn(usize) -> T + Sync + Send,
) -> Vec<T> {
    use rayon::prelude::*;
    if count > GRAIN {
        (0..count)
            .into_par_iter()
            .with_min_len(GRAIN)
            .map(f)
            .collect()
    } else {
        (0..count).map(f).collect()
    }
}

/// Turns counts into the places where rows begin: after the call `starts[i]` is the end of row i, which a
/// descending fill moves to its beginning. The last count must be 0.
pub(in crate::planar_map) fn accumulate(starts: &mut [u32]) -> usize {
    let mut total = 0u32;
    for start in starts {
        total += *start;
        *start = total;
    }
    total as usize
}
