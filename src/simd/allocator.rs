//! Memory that begins where a line of the cache begins.

use std::alloc::{GlobalAlloc, Layout, System};

/// Bytes of a line of the cache, and of the widest vector.
const LINE: usize = 64;

/// The allocator of the system, but for one thing: whatever is at least a few lines long begins at a line of the cache. Vectors
/// that are loaded from arrays otherwise lie across two lines, each of them, which made ticks of
/// 10 000 discs 13 % slower.
///
/// A program that runs large scenes with the library makes it its own:
///
/// ```
/// # use jostle_simd as simd;
/// // In a program: `use jostle::simd`.
/// #[global_allocator]
/// static LINES: simd::Lines = simd::Lines;
/// ```
pub struct Lines;

/// Gives memory that is not used back to the system, where the C library can. It keeps what a large scene took while it was read,
/// for whoever asks next: up to twice the largest list.
pub fn give_back() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        unsafe extern "C" {
            fn malloc_trim(pad: usize) -> std::ffi::c_int;
        }
        // SAFETY: it is declared as in `malloc.h`, locks what it works on, and touches nothing that is allocated.
        unsafe { malloc_trim(0) };
    }
}

fn of_lines(layout: Layout) -> Layout {
    if layout.size() < 4 * LINE {
        return layout;
    }
    layout.align_to(LINE).unwrap_or(layout)
}

// SAFETY: everything is done by the allocator of the system. Which alignment was asked of it follows from size and alignment
// alone, both of which come back with the memory.
unsafe impl GlobalAlloc for Lines {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller promises; a stricter alignment serves as well.
        unsafe { System.alloc(of_lines(layout)) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: likewise.
        unsafe { System.alloc_zeroed(of_lines(layout)) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: it was allocated with the same layout.
        unsafe { System.dealloc(memory, of_lines(layout)) }
    }
}
