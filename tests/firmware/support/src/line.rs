//! Lines of text for the host: `key=number number …` or `key=text`, one semihosting call for each line.

use core::ffi::CStr;

use semihosting::sys::arm_compat::sys_write0;

/// The length of the longest line; the rest is cut off.
const CAPACITY: usize = 160;

/// Prints `key=numbers`, the numbers in decimal and separated by blanks.
pub fn line(key: &str, numbers: &[i64]) {
    let mut text = Text::new();
    text.push_all(key.as_bytes());
    numbered(text, numbers);
}

/// Prints `group.key=numbers`.
pub(crate) fn line_of_group(group: &str, key: &str, numbers: &[i64]) {
    let mut text = Text::new();
    text.push_all(group.as_bytes());
    text.push(b'.');
    text.push_all(key.as_bytes());
    numbered(text, numbers);
}

/// Prints `key=value`.
pub fn line_of_text(key: &str, value: &str) {
    let mut text = Text::new();
    text.push_all(key.as_bytes());
    text.push(b'=');
    text.push_all(value.as_bytes());
    text.send();
}

#[inline(never)]
fn numbered(mut text: Text, numbers: &[i64]) {
    text.push(b'=');
    for (i, &number) in numbers.iter().enumerate() {
        if i > 0 {
            text.push(b' ');
        }
        text.push_number(number);
    }
    text.send();
}

/// A line under construction. What has been written is followed by zeros, as the semihosting call requires.
struct Text {
    bytes: [u8; CAPACITY],
    length: usize,
}

impl Text {
    fn new() -> Self {
        Self { bytes: [0; CAPACITY], length: 0 }
    }

    fn push(&mut self, byte: u8) {
        // Two places are reserved for the line feed and the final zero.
        if self.length < CAPACITY - 2 {
            self.put(byte);
        }
    }

    fn put(&mut self, byte: u8) {
        if let Some(place) = self.bytes.get_mut(self.length) {
            *place = byte;
            self.length += 1;
        }
    }

    fn push_all(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.push(byte);
        }
    }

    fn push_number(&mut self, number: i64) {
        if number < 0 {
            self.push(b'-');
        }
        // Digits are produced from the last to the first: 19 of them are enough for an i64.
        let mut digits = [b'0'; 20];
        let mut rest = number.unsigned_abs();
        let mut used = 0;
        for digit in &mut digits {
            *digit = b'0' + (rest % 10) as u8;
            rest /= 10;
            used += 1;
            if rest == 0 {
                break;
            }
        }
        for &digit in digits.iter().take(used).rev() {
            self.push(digit);
        }
    }

    fn send(mut self) {
        self.put(b'\n');
        if let Ok(text) = CStr::from_bytes_until_nul(&self.bytes) {
            sys_write0(text);
        }
    }
}
