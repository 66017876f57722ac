//! Several runs at once, one per thread, whose reports keep their order.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

use super::interrupt;

/// The default number of threads: one for each core.
pub(super) fn all_cores() -> usize {
    std::thread::available_parallelism().map_or(1, Into::into)
}

/// Does `work` once for each item on this many threads, until a Ctrl-C. An interrupted item has no result. `told` receives each index
/// with its result, in order. It arrives as soon as that item and all before it are done.
pub(super) fn in_order<Item: Sync, Done: Send>(
    items: &[Item],
    threads: usize,
    work: impl Fn(&Item) -> Option<Done> + Sync,
    mut told: impl FnMut(usize, Done),
) {
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, items.len().max(1)) {
            let (sender, next, work) = (sender.clone(), &next, &work);
            scope.spawn(move || {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(item) = items.get(index) else { break };
                    // If `told` has panicked, there is no receiver.
                    let done = if interrupt::asked() { None } else { work(item) };
                    if sender.send((index, done)).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let mut early = BTreeMap::new();
        let mut due = 0;
        for (index, done) in receiver {
            early.insert(index, done);
            while let Some(done) = early.remove(&due) {
                if let Some(done) = done {
                    told(due, done);
                }
                due += 1;
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::in_order;

    #[test]
    fn results_come_in_the_order_of_the_items() {
        let items: Vec<u64> = (0..40).collect();
        for threads in [1, 3, 100] {
            let mut told = Vec::new();
            let work = |&item: &u64| {
                // The first ones take longest.
                std::thread::sleep(std::time::Duration::from_micros(400 / (item + 1)));
                (item % 7 != 3).then_some(item * item)
            };
            in_order(&items, threads, work, |index, done| told.push((index as u64, done)));
            let done = items.iter().filter(|item| *item % 7 != 3);
            assert_eq!(told, done.map(|item| (*item, item * item)).collect::<Vec<_>>());
        }
        in_order(&[] as &[u64], 2, |_| Some(()), |_, ()| panic!("there is nothing to do"));
    }
}
