//! Arrays in large pages.
//!
//! A tree of a million triangles takes 100 MB. A ray that jumps about in it needs the address of another page of 4 KiB
//! at every step, more of them than a processor keeps at hand; of pages of 2 MiB there are few.

/// Arrays of fewer bytes gain nothing.
#[cfg(target_os = "linux")]
const WORTHWHILE: usize = 4 << 20;

/// Makes room for `additional` elements, in large pages where the system has any to give.
pub(super) fn reserve<T>(array: &mut Vec<T>, additional: usize) {
    match array.is_empty() {
        true => array.reserve_exact(additional),
        // Many small trees, one after the other: room for more than the next one.
        false => array.reserve(additional),
    }
    advise(array.spare_capacity_mut());
}

/// Asks for large pages. They are given when memory is first written, so this comes before.
#[cfg(target_os = "linux")]
fn advise<T>(spare: &mut [T]) {
    const PAGE: usize = 1 << 12;
    let start = spare.as_mut_ptr().cast::<u8>();
    let before = start.align_offset(PAGE);
    let bytes = size_of_val(spare).saturating_sub(before) & !(PAGE - 1);
    if bytes < WORTHWHILE {
        return;
    }
    // SAFETY: these pages are within the array, and the advice changes no contents. Refusal is as good as consent.
    unsafe { libc::madvise(start.add(before).cast(), bytes, libc::MADV_HUGEPAGE) };
}

#[cfg(not(target_os = "linux"))]
fn advise<T>(_spare: &mut [T]) {}
