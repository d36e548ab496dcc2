//! The access key of a page: random, and valid while the program runs.

use std::fmt;

/// A key of 128 random bits.
#[derive(Clone, Copy)]
pub(super) struct Key([u8; 16]);

impl Key {
    /// Generates a new key.
    ///
    /// # Errors
    /// If the operating system cannot supply random numbers.
    pub(super) fn random() -> Result<Self, getrandom::Error> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes)?;
        Ok(Self(bytes))
    }

    /// Whether a text is this key. The duration of the comparison does not reveal how much of the text is right.
    pub(super) fn is(&self, text: &str) -> bool {
        let own = self.to_string();
        let differing = |wrong: u8, (a, b): (u8, u8)| wrong | (a ^ b);
        text.len() == own.len() && own.bytes().zip(text.bytes()).fold(0, differing) == 0
    }
}

/// Hides the key, which must not appear in a log.
impl fmt::Debug for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Key")
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&kestirim_sweep::hex(&self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_is_itself_and_nothing_else() {
        let [key, other] = [0; 2].map(|_| Key::random().expect("random numbers"));
        let text = key.to_string();
        assert_eq!(text.len(), 32);
        assert!(key.is(&text) && !other.is(&text));
        assert!(!key.is("") && !key.is(&text[1..]) && !key.is(&format!("{text}0")));
    }
}
