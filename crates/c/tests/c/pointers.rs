//! Wrong pointers from a caller are reported, without any other effect.
#![allow(unsafe_code)] // Calls what C calls.

use std::ffi::{CStr, c_void};
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

use kestirim_c::{
    Health, PEDESTRIAN_SIZE, PEDESTRIAN_SNAPSHOT, Pedestrian, PedestrianConfig, PedestrianSample,
    Robot, Status, kestirim_pedestrian_align, kestirim_pedestrian_health, kestirim_pedestrian_init,
    kestirim_pedestrian_position, kestirim_pedestrian_restore, kestirim_pedestrian_size,
    kestirim_pedestrian_snapshot, kestirim_pedestrian_update, kestirim_robot_position,
    kestirim_robot_restore, kestirim_status_name,
};

const CONFIG: PedestrianConfig = PedestrianConfig { sensor: 1, contact_height: 0.07 };

/// Memory as a caller provides it.
#[repr(align(16))]
struct Memory([u8; PEDESTRIAN_SIZE]);

impl Memory {
    fn new() -> Self {
        Self([0; PEDESTRIAN_SIZE])
    }

    fn at(&mut self, offset: usize) -> *mut c_void {
        self.0.as_mut_ptr().wrapping_add(offset).cast()
    }
}

fn init(memory: *mut c_void, size: usize, config: &PedestrianConfig) -> (Status, *mut Pedestrian) {
    let mut tracker = null_mut();
    // SAFETY: what is wrong with the memory is what the function is to find.
    let status = unsafe { kestirim_pedestrian_init(memory, size, config, &raw mut tracker) };
    (status, tracker)
}

#[test]
fn memory_is_checked() {
    let size = kestirim_pedestrian_size();
    let mut memory = Memory::new();
    assert!(size <= PEDESTRIAN_SIZE && size.is_multiple_of(kestirim_pedestrian_align()));
    assert_eq!(init(null_mut(), size, &CONFIG).0, Status::NullPointer);
    assert_eq!(init(memory.at(1), size, &CONFIG).0, Status::Misaligned);
    assert_eq!(init(memory.at(0), size - 1, &CONFIG).0, Status::TooSmall);
    let wrong = PedestrianConfig { sensor: 2, ..CONFIG };
    assert_eq!(init(memory.at(0), size, &wrong), (Status::InvalidArgument, null_mut()));
    let wrong = PedestrianConfig { contact_height: f32::NAN, ..CONFIG };
    assert_eq!(init(memory.at(0), size, &wrong), (Status::NotFinite, null_mut()));
    assert_eq!(memory.0, [0; PEDESTRIAN_SIZE], "what is refused writes nothing");
    let (status, tracker) = init(memory.at(0), size, &CONFIG);
    assert_eq!((status, tracker.cast()), (Status::Ok, memory.at(0)));
}

#[test]
fn handles_and_arguments_are_checked() {
    let mut memory = Memory::new();
    let (_, tracker) = init(memory.at(0), PEDESTRIAN_SIZE, &CONFIG);
    let sample =
        PedestrianSample { time_us: 0, specific_force: [0.0, 0.0, 9.8], angular_rate: [0.0; 3] };
    let mut position = [7.0_f32; 3];
    let mut health = MaybeUninit::<Health>::uninit();
    let mut never = Memory::new();
    // SAFETY: all pointers are null, of memory that is there, or handles; each wrong one is to be found.
    unsafe {
        assert_eq!(kestirim_pedestrian_update(null_mut(), &raw const sample), Status::NullPointer);
        assert_eq!(kestirim_pedestrian_update(tracker, null()), Status::NullPointer);
        let other = never.at(0).cast();
        assert_eq!(kestirim_pedestrian_update(other, &raw const sample), Status::NotInitialised);
        let mut place = [0.0; 2];
        let robot = tracker.cast::<Robot>();
        assert_eq!(kestirim_robot_position(robot, &raw mut place), Status::NotInitialised);
        let early = kestirim_pedestrian_position(tracker, &raw mut position);
        assert_eq!((early, position), (Status::NoEstimate, [7.0; 3]));
        assert_eq!(kestirim_pedestrian_update(tracker, &raw const sample), Status::Ok);
        let wrong = PedestrianSample { specific_force: [f32::NAN; 3], ..sample };
        assert_eq!(kestirim_pedestrian_update(tracker, &raw const wrong), Status::NotFinite);
        let misaligned = (&raw mut position).cast::<u8>().wrapping_add(1).cast();
        assert_eq!(kestirim_pedestrian_position(tracker, misaligned), Status::Misaligned);
        assert_eq!(kestirim_pedestrian_position(tracker, null_mut()), Status::NullPointer);
        assert_eq!(kestirim_pedestrian_position(tracker, &raw mut position), Status::Ok);
        assert_eq!(kestirim_pedestrian_health(tracker, health.as_mut_ptr()), Status::Ok);
    }
    assert_eq!(position, [0.0; 3]);
}

#[test]
fn every_status_has_a_name() {
    let name = |status: i32| {
        // SAFETY: the function answers with a text that lives as long as the program.
        unsafe { CStr::from_ptr(kestirim_status_name(status)) }.to_str().expect("English")
    };
    let names: std::collections::BTreeSet<_> =
        (0..=Status::NoGroupDelay as i32).map(name).collect();
    assert_eq!(names.len(), Status::NoGroupDelay as usize + 1);
    assert!(!names.contains("unknown status"));
    assert_eq!([name(-1), name(24)], ["unknown status"; 2]);
}

#[test]
fn a_snapshot_is_restored_or_refused() {
    let (mut memory, mut other) = (Memory::new(), Memory::new());
    let (_, tracker) = init(memory.at(0), PEDESTRIAN_SIZE, &CONFIG);
    let mut page = [0xff_u8; PEDESTRIAN_SNAPSHOT];
    let (mut length, mut woken) = (0, null_mut());
    let page_size = page.len();
    // SAFETY: all pointers are null, of memory that is there, or handles; each wrong one is to be found.
    unsafe {
        let store = |page: *mut u8, capacity, length| {
            kestirim_pedestrian_snapshot(tracker, page, capacity, length)
        };
        assert_eq!(store(null_mut(), page_size, &raw mut length), Status::NullPointer);
        assert_eq!(store(page.as_mut_ptr(), 100, &raw mut length), Status::TooSmall);
        assert_eq!(store(page.as_mut_ptr(), page_size, &raw mut length), Status::Ok);
        assert!(length > 100 && length < page_size);
        let place = other.at(0);
        let mut restore = |page: *const u8, length| {
            kestirim_pedestrian_restore(place, PEDESTRIAN_SIZE, page, length, &raw mut woken)
        };
        assert_eq!(restore(null(), page_size), Status::NullPointer);
        assert_eq!(restore(page.as_ptr(), length - 1), Status::DamagedSnapshot);
        assert_eq!(restore(page.as_ptr(), length), Status::Ok);
        assert_eq!(restore(page.as_ptr(), page_size), Status::Ok);
        page[length - 9] ^= 1;
        assert_eq!(restore(page.as_ptr(), length), Status::DamagedSnapshot);
        page[0] = 0xff;
        assert_eq!(restore(page.as_ptr(), length), Status::NoSnapshot);
        assert_eq!(store(page.as_mut_ptr(), page_size, &raw mut length), Status::Ok);
        let (mut robot, place) = (null_mut(), other.at(0));
        let foreign =
            kestirim_robot_restore(place, PEDESTRIAN_SIZE, page.as_ptr(), length, &raw mut robot);
        assert_eq!((foreign, robot), (Status::ForeignSnapshot, null_mut()));
    }
    assert!(!woken.is_null());
}
