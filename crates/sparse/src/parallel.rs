//! Loops on all threads.
//!
//! What a thread pool needs around a loop is many times the machine code of most loops here. So a few loops over blocks, behind
//! pointers, serve them all. Blocks are of sizes that callers fix, so that no result depends on the number of threads.

use rayon::prelude::*;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// `work(k, part k)` for all parts of `size` elements, of which the last may be shorter.
pub(crate) fn for_each_part(x: &mut [f64], size: usize, work: &(dyn Fn(usize, &mut [f64]) + Sync)) {
    x.par_chunks_mut(size).enumerate().for_each(|(k, part)| work(k, part));
}

/// `work(task)` for every task, which may own places of its own in a result.
pub(crate) fn for_each_task<T: Send>(tasks: Vec<T>, work: impl Fn(T) + Sync) {
    let tasks: Vec<Mutex<Option<T>>> = tasks.into_iter().map(|task| Mutex::new(Some(task))).collect();
    for_each_block(tasks.len(), &|k| {
        let task = lock(&tasks[k]).take();
        if let Some(task) = task {
            work(task);
        }
    });
}

/// `work(scratch, k)` for k from 0 to `count`. A scratch is made once for each thread or so, and must not influence results.
pub(crate) fn map_with<S: Send, T: Send>(
    count: usize,
    scratch: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, usize) -> T + Sync,
) -> Vec<T> {
    let results: Vec<Mutex<Option<T>>> = (0..count).map(|_| Mutex::new(None)).collect();
    let idle = Mutex::new(Vec::new());
    for_each_block(count, &|k| {
        let free = lock(&idle).pop();
        let mut own = free.unwrap_or_else(&scratch);
        let result = work(&mut own, k);
        *lock(&results[k]) = Some(result);
        lock(&idle).push(own);
    });
    results.into_iter().filter_map(|r| r.into_inner().unwrap_or_else(PoisonError::into_inner)).collect()
}

/// `work(k)` for k from 0 to `count`.
pub(crate) fn map<T: Send>(count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    map_with(count, || (), |(), k| work(k))
}

/// Rows that one task works through where each gives one number or mark.
const ROWS_PER_TASK: usize = 4096;

/// `work(i)` for i from 0 to `count`, many at a time.
pub(crate) fn map_rows<T: Send + Clone + Default>(count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let mut all = vec![T::default(); count];
    for_each_task(all.chunks_mut(ROWS_PER_TASK).enumerate().collect(), |(task, own)| {
        own.iter_mut().enumerate().for_each(|(k, x)| *x = work(task * ROWS_PER_TASK + k));
    });
    all
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn for_each_block(blocks: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..blocks).into_par_iter().with_max_len(1).for_each(work);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_order() {
        for count in [0, 1, 4095, 10_000] {
            let squares =
                |all: Vec<usize>| all.len() == count && all.iter().enumerate().all(|(i, s)| *s == i * i);
            assert!(squares(map(count, |i| i * i)) && squares(map_rows(count, |i| i * i)));
        }
    }

    #[test]
    fn every_part_and_every_task_is_worked_on_once() {
        let mut x = vec![0.0; 1000];
        for_each_part(&mut x, 300, &|k, part| part.iter_mut().for_each(|x| *x += k as f64));
        assert!(x.iter().enumerate().all(|(i, x)| *x == (i / 300) as f64));
        for_each_task(x.chunks_mut(7).collect(), |own| own.iter_mut().for_each(|x| *x += 1.0));
        assert!(x.iter().enumerate().all(|(i, x)| *x == (i / 300 + 1) as f64));
    }
}
