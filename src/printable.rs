//! Text that may come from a file, made safe to show: a terminal obeys what is hidden in it.

use std::borrow::Cow;
use std::io::{self, Write};

/// Characters that do something instead of being seen: the controls of C0, C1 and DEL but for line feed and tab, and
/// those that turn the direction of writing or break a line.
fn acts(c: char) -> bool {
    match c {
        '\n' | '\t' => false,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => true,
        c => c.is_control(),
    }
}

/// `text` with such characters as escapes, like `\u{1b}`.
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(acts) {
        return text.into();
    }
    text.chars()
        .map(|c| if acts(c) { c.escape_unicode().to_string() } else { c.to_string() })
        .collect::<String>()
        .into()
}

/// The same in a single line.
pub fn line(text: &str) -> String {
    printable(text).replace('\n', "\\n").replace('\t', "\\t")
}

/// How a character that acts is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Escapes {
    /// `\u{9b}`
    Text,
    /// `\u009b`, as in a string of JSON
    Json,
}

/// Writes on what is written to it, made safe.
pub struct Printable<W> {
    inner: W,
    escapes: Escapes,
}

impl<W: Write> Printable<W> {
    pub fn new(inner: W, escapes: Escapes) -> Self {
        Self { inner, escapes }
    }

    fn text(&mut self, text: &str) -> io::Result<()> {
        for piece in text.split_inclusive(acts) {
            let Some(c) = piece.chars().next_back().filter(|&c| acts(c)) else {
                self.inner.write_all(piece.as_bytes())?;
                continue;
            };
            self.inner.write_all(&piece.as_bytes()[..piece.len() - c.len_utf8()])?;
            match self.escapes {
                Escapes::Text => write!(self.inner, "{}", c.escape_unicode())?,
                // None of them is beyond the first plane.
                Escapes::Json => write!(self.inner, "\\u{:04x}", u32::from(c))?,
            }
        }
        Ok(())
    }
}

impl<W: Write> Write for Printable<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for chunk in bytes.utf8_chunks() {
            self.text(chunk.valid())?;
            chunk.invalid().iter().try_for_each(|byte| write!(self.inner, "\\x{byte:02x}"))?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(bytes: &[u8], escapes: Escapes) -> String {
        let mut out = Vec::new();
        Printable::new(&mut out, escapes).write_all(bytes).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn what_acts_is_shown_instead() {
        for (text, shown) in [
            ("", ""),
            ("a \u{e9}\u{4e2d}\u{1f600}\n\tb", "a \u{e9}\u{4e2d}\u{1f600}\n\tb"),
            ("\u{1b}[31mred\u{1b}[0m", "\\u{1b}[31mred\\u{1b}[0m"),
            ("a\rb\0\u{7f}\u{9b}2J", "a\\u{d}b\\u{0}\\u{7f}\\u{9b}2J"),
            ("\u{202e}gnp.exe\u{2066}", "\\u{202e}gnp.exe\\u{2066}"),
        ] {
            assert_eq!(printable(text), shown);
            assert_eq!(written(text.as_bytes(), Escapes::Text), shown);
        }
        assert_eq!(line("a\n\tb\u{7}"), "a\\n\\tb\\u{7}");
    }

    #[test]
    fn bytes_that_are_no_text_are_shown_too() {
        assert_eq!(written(b"a\x9bb\xffc\xc3", Escapes::Text), "a\\x9bb\\xffc\\xc3");
    }

    #[test]
    fn json_stays_json() {
        let text = "\u{1b}\u{7f}\u{9b}\u{202e}\n";
        let safe = written(serde_json::to_string(text).unwrap().as_bytes(), Escapes::Json);
        assert!(safe.is_ascii(), "{safe}");
        assert_eq!(serde_json::from_str::<String>(&safe).unwrap(), text);
    }
}
