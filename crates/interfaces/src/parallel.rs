//! Loops over nodes on all threads, with results in the order of the nodes.
//!
//! What a thread pool needs around a loop is ten times the machine code of most loops here, for every loop and dimension.
//! So one loop over blocks, behind a pointer, serves them all; its results do not depend on the number of threads, nor
//! does which of several errors is returned.

use std::convert::Infallible;
use std::sync::{Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;

/// Blocks that a loop is cut into, where it is long enough: more than there are threads, so that none waits for long.
const BLOCKS: usize = 256;

/// Longest block.
const LONGEST: usize = 128;

/// `work(scratch, i)` for i from 0 to `count`. A scratch is made once for each thread or so, and must not influence
/// results.
pub(crate) fn map_with<S: Send, T: Send>(
    count: usize,
    scratch: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, usize) -> T + Sync,
) -> Vec<T> {
    let push = |scratch: &mut S, i: usize, out: &mut Vec<T>| {
        out.push(work(scratch, i));
        Ok::<(), Infallible>(())
    };
    let Ok(all) = try_collect_with(count, &scratch, &push);
    all
}

/// `work(i)` for i from 0 to `count`.
pub(crate) fn map<T: Send>(count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    map_with(count, || (), |(), i| work(i))
}

/// Like [`map_with`], for work that may fail.
///
/// # Errors
/// That of the lowest i.
pub(crate) fn try_map_with<S: Send, T: Send, E: Send>(
    count: usize,
    scratch: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, usize) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    try_collect_with(count, &scratch, &|scratch, i, out| work(scratch, i).map(|value| out.push(value)))
}

/// What `push(i, out)` appends to `out` for i from 0 to `count`, in that order.
pub(crate) fn collect<T: Send>(count: usize, push: impl Fn(usize, &mut Vec<T>) + Sync) -> Vec<T> {
    let push = |(): &mut (), i: usize, out: &mut Vec<T>| {
        push(i, out);
        Ok::<(), Infallible>(())
    };
    let Ok(all) = try_collect_with(count, &|| (), &push);
    all
}

/// Appends what belongs to a number.
type Push<'a, S, T, E> = dyn Fn(&mut S, usize, &mut Vec<T>) -> Result<(), E> + Sync + 'a;

/// All of the above.
fn try_collect_with<S: Send, T: Send, E: Send>(
    count: usize,
    scratch: &(dyn Fn() -> S + Sync),
    push: &Push<'_, S, T, E>,
) -> Result<Vec<T>, E> {
    let length = (count / BLOCKS).clamp(1, LONGEST);
    let blocks = slots((0..count.div_ceil(length)).map(|_| Ok(Vec::new())));
    let pool = Pool { idle: Mutex::new(Vec::new()), make: scratch };
    for_each_block(blocks.len(), &|block| {
        let mut out = Vec::new();
        let done = pool.with(|scratch| {
            (block * length..count.min((block + 1) * length)).try_for_each(|i| push(scratch, i, &mut out))
        });
        *lock(&blocks[block]) = done.map(|()| out);
    });
    let mut all = Vec::with_capacity(count);
    for block in blocks {
        all.append(&mut block.into_inner().unwrap_or_else(PoisonError::into_inner)?);
    }
    Ok(all)
}

/// `work(scratch, task)` for every task, which may own places of its own in a result.
///
/// # Errors
/// That of the first task in the list.
pub(crate) fn for_each_with<S: Send, T: Send, E: Send>(
    tasks: Vec<T>,
    scratch: &(dyn Fn() -> S + Sync),
    work: &(dyn Fn(&mut S, T) -> Result<(), E> + Sync),
) -> Result<(), E> {
    let tasks = slots(tasks.into_iter().map(Some));
    let outcomes = slots(tasks.iter().map(|_| Ok(())));
    let pool = Pool { idle: Mutex::new(Vec::new()), make: scratch };
    for_each_block(tasks.len(), &|k| {
        if let Some(task) = lock(&tasks[k]).take() {
            *lock(&outcomes[k]) = pool.with(|scratch| work(scratch, task));
        }
    });
    outcomes.into_iter().try_for_each(|outcome| outcome.into_inner().unwrap_or_else(PoisonError::into_inner))
}

fn slots<T>(items: impl Iterator<Item = T>) -> Vec<Mutex<T>> {
    items.map(Mutex::new).collect()
}

/// Scratch that no thread uses at the moment.
struct Pool<'a, S> {
    idle: Mutex<Vec<S>>,
    make: &'a (dyn Fn() -> S + Sync),
}

impl<S> Pool<'_, S> {
    fn with<R>(&self, work: impl FnOnce(&mut S) -> R) -> R {
        let idle = lock(&self.idle).pop();
        let mut scratch = idle.unwrap_or_else(self.make);
        let result = work(&mut scratch);
        lock(&self.idle).push(scratch);
        result
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The only loop that the thread pool sees.
fn for_each_block(blocks: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..blocks).into_par_iter().with_max_len(1).for_each(work);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_order_whatever_the_length() {
        for count in [0, 1, 255, 256, 1000, 100_000] {
            let squares = map(count, |i| i * i);
            assert!(squares.len() == count && squares.iter().enumerate().all(|(i, s)| *s == i * i));
        }
    }

    #[test]
    fn the_first_error_is_returned() {
        let work = |(): &mut (), i: usize| if i % 700 == 699 { Err(i) } else { Ok(i) };
        assert_eq!(try_map_with(5000, || (), work), Err(699));
        let odd = |(): &mut (), i: usize| if i % 2 == 1 { Err(i) } else { Ok(()) };
        assert_eq!(for_each_with(vec![2, 5, 4, 3], &|| (), &odd), Err(5));
    }

    #[test]
    fn a_node_may_have_none_or_several_results() {
        let some = |i: usize| std::iter::repeat_n(i, i % 3);
        assert_eq!(collect(900, |i, out| out.extend(some(i))), (0..900).flat_map(some).collect::<Vec<_>>());
    }
}
