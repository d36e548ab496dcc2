//! Turns C's pointers into references; all `unsafe` code of this crate's internals is here.
//!
//! These are checked: that a pointer is not null, that it is aligned, that memory is large enough, and that it holds
//! what its handle claims. What cannot be checked is stated at the beginning of the header: that memory belongs to the
//! caller, is as large as stated, and is not used by another call at the same time.
#![allow(unsafe_code)] // C hands over pointers, and nothing but a pointer.

use core::ffi::c_void;
use core::mem::{MaybeUninit, size_of};
use core::slice;

use kestirim_snapshot::{Layout, load, store};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::Status;

/// The largest number of elements that is accepted for any array from C.
const MOST: usize = 4096;

/// The number of bytes that every snapshot stays below.
const LONGEST: usize = 1 << 16;

/// A handle type, C's name for an object, and the type of the object behind it.
pub(crate) trait Handle {
    /// The contents of the memory.
    type Value;
    /// Distinguishes the objects of this type from all others, and from memory without an object.
    const TAG: u32;
}

/// An object in the caller's memory.
#[repr(C)]
struct Held<V> {
    tag: u32,
    value: V,
}

/// The size of an object, bytes.
pub(crate) const fn size<H: Handle>() -> usize {
    size_of::<Held<H::Value>>()
}

/// The alignment of an object, bytes.
pub(crate) const fn align<H: Handle>() -> usize {
    align_of::<Held<H::Value>>()
}

fn check<T>(pointer: *const T) -> Result<(), Status> {
    if pointer.is_null() {
        Err(Status::NullPointer)
    } else if !pointer.is_aligned() {
        Err(Status::Misaligned)
    } else {
        Ok(())
    }
}

/// Creates an object in memory, and its handle.
///
/// # Safety
/// `memory` is the caller's, for `size` bytes, and `handle` may be written.
#[inline]
pub(crate) unsafe fn init<H: Handle>(
    memory: *mut c_void,
    given: usize,
    handle: *mut *mut H,
    make: impl FnOnce() -> Result<H::Value, Status>,
) -> Status {
    let held = memory.cast::<Held<H::Value>>();
    if let Err(status) = check(held).and_then(|()| check(handle)) {
        return status;
    }
    if given < size::<H>() {
        return Status::TooSmall;
    }
    match make() {
        Ok(value) => {
            // SAFETY: checked to be neither null nor misaligned, and large enough; the rest is the caller's word.
            unsafe {
                held.write(Held { tag: H::TAG, value });
                handle.write(held.cast());
            }
            Status::Ok
        }
        Err(status) => status,
    }
}

/// The object of a handle.
///
/// # Safety
/// `handle` is null or one that [`init`] made, whose memory is not changed meanwhile.
#[inline]
pub(crate) unsafe fn held<'a, H: Handle>(handle: *const H) -> Result<&'a H::Value, Status> {
    let held = handle.cast::<Held<H::Value>>();
    check(held)?;
    // SAFETY: neither null nor misaligned, so it is what `init` made, unless the caller's word does not hold: then the
    // tag, a number that any memory may be read as, most likely tells.
    if unsafe { (&raw const (*held).tag).read() } != H::TAG {
        return Err(Status::NotInitialised);
    }
    // SAFETY: the tag says that `init` wrote the whole object.
    Ok(unsafe { &(*held).value })
}

/// The object of a handle, mutably.
///
/// # Safety
/// As [`held`], and the memory is not read meanwhile.
#[inline]
pub(crate) unsafe fn held_mut<'a, H: Handle>(handle: *mut H) -> Result<&'a mut H::Value, Status> {
    // SAFETY: the caller's word is the same.
    unsafe { held(handle.cast_const()) }?;
    // SAFETY: it is an object, and the caller's word is that nobody else uses it.
    Ok(unsafe { &mut (*handle.cast::<Held<H::Value>>()).value })
}

/// Stores an object in a buffer, and writes the number of bytes that it takes there to `length`.
///
/// # Safety
/// As [`held`]; `buffer` is the caller's for `capacity` bytes, and `length` may be written.
#[inline]
pub(crate) unsafe fn snapshot<H: Handle>(
    handle: *const H,
    buffer: *mut u8,
    capacity: usize,
    length: *mut usize,
) -> Status
where
    H::Value: Layout + Serialize,
{
    status(|| {
        // SAFETY: the caller's word is the same.
        let (object, length) = unsafe { (held(handle)?, place(length)?) };
        check(buffer)?;
        // SAFETY: not null, and not longer than the caller says. Bytes are written before they are read.
        let buffer = unsafe { slice::from_raw_parts_mut(buffer, capacity.min(LONGEST)) };
        length.write(store(object, buffer)?.len());
        Ok(())
    })
}

/// Creates an object in memory from what [`snapshot`] stored, and its handle.
///
/// # Safety
/// As [`init`]; `bytes` may be read for `length`.
#[inline]
pub(crate) unsafe fn restore<H: Handle>(
    memory: *mut c_void,
    given: usize,
    bytes: *const u8,
    length: usize,
    handle: *mut *mut H,
) -> Status
where
    H::Value: Layout + Serialize + DeserializeOwned,
{
    // SAFETY: the caller's word is the same; what is beyond the longest snapshot is not looked at.
    unsafe {
        init(memory, given, handle, || {
            check(bytes)?;
            Ok(load(slice::from_raw_parts(bytes, length.min(LONGEST)))?)
        })
    }
}

/// Copies an argument.
///
/// # Safety
/// `pointer` is null or may be read. `T` consists of plain numbers, for which all bit patterns are valid.
#[inline]
pub(crate) unsafe fn argument<T: Copy>(pointer: *const T) -> Result<T, Status> {
    check(pointer)?;
    // SAFETY: neither null nor misaligned; that it may be read is the caller's word.
    Ok(unsafe { pointer.read() })
}

/// Copies an optional argument, which a null pointer leaves out.
///
/// # Safety
/// As [`argument`].
#[inline]
pub(crate) unsafe fn optional<T: Copy>(pointer: *const T) -> Result<Option<T>, Status> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's word is the same.
    unsafe { argument(pointer) }.map(Some)
}

/// An array; if it is empty, the pointer is not looked at.
///
/// # Safety
/// `pointer` may be read for `count` elements, which are not changed meanwhile. `T` consists of plain numbers.
#[inline]
pub(crate) unsafe fn array<'a, T>(pointer: *const T, count: usize) -> Result<&'a [T], Status> {
    if count == 0 {
        return Ok(&[]);
    }
    check(pointer)?;
    if count > MOST {
        return Err(Status::TooMany);
    }
    // SAFETY: neither null nor misaligned, and not too long; that it may be read is the caller's word.
    Ok(unsafe { slice::from_raw_parts(pointer, count) })
}

/// The destination of a result.
///
/// # Safety
/// `pointer` is null or may be written, and the place is not used meanwhile.
#[inline]
pub(crate) unsafe fn place<'a, T>(pointer: *mut T) -> Result<&'a mut MaybeUninit<T>, Status> {
    check(pointer)?;
    // SAFETY: neither null nor misaligned; whatever is there is nothing yet.
    Ok(unsafe { &mut *pointer.cast() })
}

/// The destination of an optional result, which a null pointer declines.
///
/// # Safety
/// As [`place`].
#[inline]
pub(crate) unsafe fn wanted<'a, T>(
    pointer: *mut T,
) -> Result<Option<&'a mut MaybeUninit<T>>, Status> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's word is the same.
    unsafe { place(pointer) }.map(Some)
}

/// The status that a call returns.
#[inline]
pub(crate) fn status(run: impl FnOnce() -> Result<(), Status>) -> Status {
    match run() {
        Ok(()) => Status::Ok,
        Err(status) => status,
    }
}
