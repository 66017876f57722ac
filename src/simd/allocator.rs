//! Allocation of arrays at the beginning of a cache line (64 bytes).

use std::alloc::{GlobalAlloc, Layout, System};

/// Bytes of a line of the cache, and of the widest vector.
const LINE: usize = 64;

/// The allocator of the system, except that each allocation of several cache lines begins at a cache line. Otherwise
/// each vector that is loaded from an array lies across two lines, and ticks of large scenes take longer.
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

/// Returns unused memory to the system, if the C library can. The C library keeps the memory that the reading of a
/// large scene took, for later allocations. It amounts to up to twice the largest list.
pub fn give_back() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        unsafe extern "C" {
            fn malloc_trim(pad: usize) -> std::ffi::c_int;
        }
        // SAFETY: the declaration is that of `malloc.h`. The function locks its data, and touches no allocated memory.
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
