//! Several runs at once: each has a thread of its own, and what is told of them keeps their order.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

/// Threads when nobody says how many: one for each core.
pub(super) fn all_cores() -> usize {
    std::thread::available_parallelism().map_or(1, Into::into)
}

/// Does `work` once for each item, on so many threads, and hands the results to `told` in the order of the items, each as
/// soon as it and all before it are done.
pub(super) fn in_order<Item: Sync, Done: Send>(
    items: &[Item],
    threads: usize,
    work: impl Fn(&Item) -> Done + Sync,
    mut told: impl FnMut(Done),
) {
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, items.len().max(1)) {
            let (sender, next, work) = (sender.clone(), &next, &work);
            scope.spawn(move || {
                loop {
                    let place = next.fetch_add(1, Ordering::Relaxed);
                    let Some(item) = items.get(place) else { break };
                    // Nobody listens any more when what was told has panicked.
                    if sender.send((place, work(item))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let mut early = BTreeMap::new();
        let mut due = 0;
        for (place, done) in receiver {
            early.insert(place, done);
            while let Some(done) = early.remove(&due) {
                told(done);
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
                item * item
            };
            in_order(&items, threads, work, |done| told.push(done));
            assert_eq!(told, items.iter().map(|item| item * item).collect::<Vec<_>>());
        }
        in_order(&[] as &[u64], 2, |_| (), |()| panic!("there is nothing to do"));
    }
}
