//! Pages of results: one file of HTML without anything from elsewhere, and the folder that it lies in.

mod folder;

use std::fmt::Write as _;

use crate::gpu::Info;
use crate::printable::printable;

pub(crate) use crate::chart::{png_bytes, write_png};
pub(crate) use folder::{INDEX, csv_text, numbers_csv, open};

const STYLE: &str = "
:root { color-scheme: light dark; --ink: #1d2127; --soft: #5b6470; --line: #d9dde3; --ground: #fff; --card: #f6f7f9 }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6e8eb; --soft: #9aa4b1; --line: #363c45; --ground: #14171b; --card: #1c2026 } }
body { font: 17px/1.55 system-ui, sans-serif; color: var(--ink); background: var(--ground);
  max-width: 62rem; margin: 0 auto; padding: 2rem 1.2rem 4rem }
h1 { font-size: 1.7rem; margin: 0 0 .3rem } h2 { font-size: 1.4rem; margin: 3.5rem 0 .5rem }
p { max-width: 46rem } a { color: inherit } code { font-size: .9em }
.soft, figcaption, caption { color: var(--soft); font-size: .93rem }
figure { margin: 1.8rem 0 } figcaption { margin-top: .5rem; max-width: 56rem }
img { max-width: 100%; height: auto; background: #fff; border: 1px solid var(--line); border-radius: 6px }
.wide { overflow-x: auto } table { border-collapse: collapse; margin: .8rem 0; font-size: .95rem }
caption { text-align: left; padding-bottom: .4rem }
th, td { text-align: left; padding: .25rem 1.1rem .25rem 0; border-bottom: 1px solid var(--line); vertical-align: top }
code, .unbroken { white-space: nowrap }
td.number { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums }
details { background: var(--card); border-radius: 6px; padding: .5rem .9rem; margin: .8rem 0 }
nav ol { padding-left: 1.2rem } footer { margin-top: 4rem; border-top: 1px solid var(--line); padding-top: .8rem }
";

/// How a page begins; `generator` is the line that tells it from other programs' pages.
pub(crate) fn head(title: &str, generator: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n{generator}\n\
         <title>{}</title>\n<style>{STYLE}</style>\n",
        escaped(title)
    )
}

/// The footer that says what drew it.
pub(crate) fn drawn_on(Info { renderer, version, backend, route, .. }: &Info) -> String {
    let gl = format!("{renderer}, OpenGL {version} through {backend} ({route})");
    format!("<footer class=\"soft\">Drawn on {}.</footer>\n", escaped(&gl))
}

/// A table of names and values.
pub(crate) fn pairs(caption: &str, pairs: &[(String, String)]) -> String {
    let mut text = String::from("<div class=\"wide\"><table>\n");
    if !caption.is_empty() {
        let _ = writeln!(text, "<caption>{}</caption>", escaped(caption));
    }
    for (name, value) in pairs {
        let _ = writeln!(text, "<tr><th scope=\"row\">{}</th>{}</tr>", shown(name), cell(value));
    }
    text + "</table></div>\n"
}

/// A cell; numbers stand at the right.
pub(crate) fn cell(value: &str) -> String {
    let number = value.parse::<f64>().is_ok();
    format!("<td{}>{}</td>", if number { " class=\"number\"" } else { "" }, shown(value))
}

/// Text between tags: escaped, and with numbers like 3.2e-3 kept on one line, which browsers would break at the hyphen.
pub(crate) fn shown(text: &str) -> String {
    unbroken(&escaped(text))
}

/// Text that is escaped already, with such numbers kept on one line.
pub(crate) fn unbroken(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find("e-") {
        let (before, after) = (&rest[..at], &rest[at + 2..]);
        let start = before.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.').len();
        let end = after.find(|c: char| !c.is_ascii_digit()).unwrap_or(after.len());
        let (words, number) = (&before[..start], &rest[start..at + 2 + end]);
        match start < at && end > 0 {
            true => out.extend([words, "<span class=\"unbroken\">", number, "</span>"]),
            false => out.extend([words, number]),
        }
        rest = &after[end..];
    }
    out + rest
}

/// Text as it may stand in HTML, where what would act and not be seen is told by its number.
pub(crate) fn escaped(text: &str) -> String {
    printable(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_act_on_a_page_is_shown() {
        let name = "<b>&\"\u{1b}[2J\u{7}\u{9b}\u{202e}é.exr";
        let expected = r"&lt;b&gt;&amp;&quot;\u{1b}[2J\u{7}\u{9b}\u{202e}é.exr";
        assert_eq!(escaped(name), expected);
        assert_eq!(shown(name), expected);
    }

    #[test]
    fn numbers_with_exponents_are_not_broken() {
        let number = "<span class=\"unbroken\">3.2e-3</span>";
        assert_eq!(shown("error 3.2e-3; a <b>"), format!("error {number}; a &lt;b&gt;"));
        assert_eq!(cell("3.2e-3"), format!("<td class=\"number\">{number}</td>"));
        assert_eq!(shown("(3.2e-3)"), format!("({number})"));
        for words in ["the-fine e-mail", "e-3", "1e", "1e-x", "1e3", "", "e-"] {
            assert_eq!(shown(words), words);
        }
        assert!(shown("1e-1 to 1e-6").ends_with(" to <span class=\"unbroken\">1e-6</span>"));
    }
}
