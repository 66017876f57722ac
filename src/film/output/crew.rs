//! Dynamic scheduling: threads take jobs from a shared queue.

use std::sync::Mutex;

/// Does `work` once for each job. Each worker is one thread with its tools, and takes the next job when it has finished
/// the last. A single worker does all jobs in this thread. Returns when every job is done.
pub(super) fn share_out<Worker: Send, Job: Send>(
    workers: &mut [Worker],
    jobs: &mut [Job],
    work: impl Fn(&mut Worker, &mut Job) + Sync,
) {
    if let [only] = workers {
        jobs.iter_mut().for_each(|job| work(only, job));
        return;
    }
    let queue = Mutex::new(jobs.iter_mut());
    std::thread::scope(|scope| {
        for worker in workers {
            scope.spawn(|| {
                // The lock is free again before the work begins.
                while let Some(job) = queue.lock().ok().and_then(|mut queue| queue.next()) {
                    work(worker, job);
                }
            });
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_job_is_done_once() {
        for count in [1, 2, 5] {
            let mut workers = vec![0_u32; count];
            let mut jobs = vec![0_u32; 37];
            share_out(&mut workers, &mut jobs, |done, job| {
                *done += 1;
                *job += 1;
            });
            assert_eq!(jobs, vec![1; 37]);
            assert_eq!(workers.iter().sum::<u32>(), 37);
        }
    }
}
