//! An allocator that counts, for tests of what allocates.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

/// The allocator of the system. It counts the allocations of each thread.
///
/// ```
/// # use jostle_simd as simd;
/// // In a test: `use jostle::simd`.
/// #[global_allocator]
/// static COUNTING: simd::Counting = simd::Counting;
///
/// let before = simd::Counting::allocations();
/// drop(vec![0; 3]);
/// assert_eq!(simd::Counting::allocations(), before + 1);
/// ```
pub struct Counting;

impl Counting {
    /// The allocations of the present thread so far.
    pub fn allocations() -> u64 {
        COUNT.with(Cell::get)
    }
}

fn count() {
    // A thread that ends has put its counter away.
    let _ = COUNT.try_with(|count| count.set(count.get() + 1));
}

// SAFETY: everything is done by the allocator of the system. The counter is no memory that it gives out.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: as the caller promises.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: as the caller promises.
        unsafe { System.realloc(memory, layout, size) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(memory, layout) }
    }
}
