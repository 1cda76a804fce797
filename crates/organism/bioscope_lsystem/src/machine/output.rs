//! What a model prints and the files it reads and writes: bounded, and only in one folder.

use std::{
    fs,
    path::{Component, Path, PathBuf},
};

use crate::string::general;

/// How many bytes a model may print, and read from or write to one file.
const SIZE_LIMIT: usize = 1 << 20;
/// How many files may be open at once.
const FILE_LIMIT: usize = 32;

/// Captured output, and open files.
#[derive(Debug, Default)]
pub(crate) struct Output {
    /// What was printed.
    pub text: String,
    /// Where files may be; none forbids them.
    pub folder: Option<PathBuf>,
    files: Vec<Option<File>>,
}

#[derive(Debug)]
struct File {
    path: PathBuf,
    /// What is read, or will be written.
    content: String,
    /// Next byte to be read; none for a file that is written.
    position: Option<usize>,
}

type Done<T> = Result<T, String>;

impl Output {
    /// Appends formatted text to what was printed.
    pub fn print(&mut self, pattern: &str, numbers: &[f64]) {
        format(pattern, numbers, &mut self.text);
    }

    /// Appends formatted text to a file.
    pub fn print_to(&mut self, number: f64, pattern: &str, numbers: &[f64]) -> Done<f64> {
        let file = self.file(number)?;
        if file.position.is_some() {
            return Err(format!("file '{}' is open for reading", file.path.display()));
        }
        format(pattern, numbers, &mut file.content);
        Ok(0.0)
    }

    /// Opens a file of the folder; its number.
    pub fn open(&mut self, name: &str, mode: &str) -> Done<f64> {
        let path = self.place(name)?;
        let number = self.files.iter().position(Option::is_none).unwrap_or(self.files.len());
        if number >= FILE_LIMIT {
            return Err(format!("more than {FILE_LIMIT} open files"));
        }
        let read = |path: &Path| read_bounded(path).unwrap_or_default();
        let file = match mode.chars().next() {
            Some('r') => {
                let Some(content) = read_bounded(&path) else { return Ok(-1.0) };
                File { path, content, position: Some(0) }
            }
            Some('a') => File { content: read(&path), path, position: None },
            Some('w') => File { path, content: String::new(), position: None },
            _ => return Err(format!("fopen() mode '{mode}'; expected \"r\", \"w\" or \"a\"")),
        };
        if number == self.files.len() {
            self.files.push(None);
        }
        self.files[number] = Some(file);
        Ok(number as f64)
    }

    /// Closes a file.
    pub fn close(&mut self, number: f64) -> Done<f64> {
        self.flush(number)?;
        self.files[number as usize] = None;
        Ok(0.0)
    }

    /// Writes a file out.
    pub fn flush(&mut self, number: f64) -> Done<f64> {
        let file = self.file(number)?;
        if file.position.is_none() {
            let path = &file.path;
            fs::write(path, &file.content)
                .map_err(|error| format!("{}: {error}", path.display()))?;
        }
        Ok(number)
    }

    /// Writes all open files out.
    pub fn finish(&mut self) -> Done<()> {
        for number in 0..self.files.len() {
            if self.files[number].is_some() {
                self.close(number as f64)?;
            }
        }
        Ok(())
    }

    /// Reads up to so many numbers, and whether the file ended.
    pub fn scan(&mut self, number: f64, pattern: &str, count: u8) -> Done<(Vec<f64>, bool)> {
        let file = self.file(number)?;
        let Some(position) = &mut file.position else {
            return Err(format!("file '{}' is open for writing", file.path.display()));
        };
        Ok(scan(pattern, count as usize, &file.content, position))
    }

    fn file(&mut self, number: f64) -> Done<&mut File> {
        let file = (number >= 0.0).then(|| self.files.get_mut(number as usize)).flatten();
        file.and_then(Option::as_mut).ok_or_else(|| format!("no open file has the number {number}"))
    }

    fn place(&self, name: &str) -> Done<PathBuf> {
        let Some(folder) = &self.folder else {
            return Err(format!("file '{name}': this model was given no folder for files"));
        };
        let path = Path::new(name);
        if name.is_empty() || !path.components().all(|part| matches!(part, Component::Normal(_))) {
            return Err(format!("file '{name}' is outside the folder that the model was given"));
        }
        Ok(folder.join(path))
    }
}

fn read_bounded(path: &Path) -> Option<String> {
    let size = fs::metadata(path).ok()?.len();
    if size > SIZE_LIMIT as u64 {
        return None;
    }
    Some(String::from_utf8_lossy(&fs::read(path).ok()?).into_owned())
}

/// Appends text with numbers in place of `%g`, `%d`, `%5.2f` … as `printf` does.
fn format(pattern: &str, numbers: &[f64], out: &mut String) {
    let mut numbers = numbers.iter();
    let mut rest = pattern;
    while let Some(start) = rest.find('%') {
        out.push_str(&rest[..start]);
        rest = &rest[start + 1..];
        let end = rest.find(|letter: char| letter.is_ascii_alphabetic() && letter != 'l');
        if let Some(after) = rest.strip_prefix('%') {
            out.push('%');
            rest = after;
        } else if let Some(end) = end {
            let number = numbers.next().copied().unwrap_or(0.0);
            conversion(&rest[..end], rest.as_bytes()[end], number, out);
            rest = &rest[end + 1..];
        }
        if out.len() > SIZE_LIMIT {
            break;
        }
    }
    out.push_str(rest);
    truncate(out);
}

fn truncate(out: &mut String) {
    let mut end = SIZE_LIMIT.min(out.len());
    while !out.is_char_boundary(end) {
        end -= 1;
    }
    out.truncate(end);
}

fn conversion(flags: &str, letter: u8, number: f64, out: &mut String) {
    const WIDEST: usize = 200;
    let left = flags.contains('-');
    let zero = flags.starts_with('0');
    let digits = flags.trim_start_matches(['-', '+', ' ', '#']).trim_end_matches('l');
    let (width, precision) = digits.split_once('.').unwrap_or((digits, ""));
    let width: usize = width.parse().unwrap_or(0).min(WIDEST);
    let precision: usize = precision.parse().unwrap_or(6).min(WIDEST);
    let text = match letter {
        b'd' | b'i' | b'u' => format!("{}", number as i64),
        b'x' => format!("{:x}", number as i64),
        b'c' => char::from(number as u8).to_string(),
        b'e' => exponential(number, precision),
        b'f' => format!("{number:.precision$}"),
        _ => general(number, precision.max(1)),
    };
    let missing = width.saturating_sub(text.chars().count());
    let (before, after) = if left { (0, missing) } else { (missing, 0) };
    out.extend(std::iter::repeat_n(if zero { '0' } else { ' ' }, before));
    out.push_str(&text);
    out.extend(std::iter::repeat_n(' ', after));
}

fn exponential(number: f64, precision: usize) -> String {
    let text = format!("{number:.precision$e}");
    match text.split_once('e') {
        Some((mantissa, exponent)) => {
            let exponent: i32 = exponent.parse().unwrap_or(0);
            let sign = if exponent < 0 { '-' } else { '+' };
            format!("{mantissa}e{sign}{:02}", exponent.abs())
        }
        None => text,
    }
}

/// Reads numbers where the pattern has `%f`, `%lf`, `%d` …; other text must be there.
fn scan(pattern: &str, count: usize, text: &str, position: &mut usize) -> (Vec<f64>, bool) {
    let mut numbers = Vec::new();
    let mut letters = pattern.chars().peekable();
    while let Some(letter) = letters.next() {
        let rest = &text[*position..];
        let blanks = rest.len() - rest.trim_start().len();
        if letter == '%' {
            while letters
                .next()
                .is_some_and(|letter| !letter.is_ascii_alphabetic() || letter == 'l')
            {}
            let trimmed = rest.trim_start();
            let is_part = |letter: char| letter.is_ascii_digit() || ".+-eE".contains(letter);
            let length = trimmed.find(|letter| !is_part(letter)).unwrap_or(trimmed.len());
            let Ok(number) = trimmed[..length].parse() else { break };
            *position += blanks + length;
            if numbers.len() < count {
                numbers.push(number);
            }
        } else if letter.is_whitespace() {
            *position += blanks;
        } else if rest.starts_with(letter) {
            *position += letter.len_utf8();
        } else {
            break;
        }
    }
    (numbers, text[*position..].trim_start().is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(pattern: &str, numbers: &[f64]) -> String {
        let mut output = Output::default();
        output.print(pattern, numbers);
        output.text
    }

    #[test]
    fn numbers_are_printed_as_in_c() {
        assert_eq!(printed("%g and %d%%\n", &[0.1, 7.9]), "0.1 and 7%\n");
        assert_eq!(printed("%6.2f|%-4d|%04d", &[2.5, 5.0, 42.0]), "  2.50|5   |0042");
        assert_eq!(printed("%e %g %g", &[12345.678, 1e20, 1e-7]), "1.234568e+04 1e+20 1e-07");
        assert_eq!(printed("%f", &[]), "0.000000");
        assert_eq!(printed("100%", &[]), "100");
    }

    #[test]
    fn printing_is_bounded() {
        let mut output = Output::default();
        for _ in 0..2000 {
            output.print(&"x".repeat(1000), &[]);
        }
        assert_eq!(output.text.len(), SIZE_LIMIT);
    }

    #[test]
    fn numbers_are_read_as_in_c() {
        let mut position = 0;
        let text = "x = 1.5, -2\n 7 end";
        assert_eq!(scan("x = %f,%lf", 2, text, &mut position), (vec![1.5, -2.0], false));
        assert_eq!(scan("%d", 1, text, &mut position), (vec![7.0], false));
        assert_eq!(scan("%d", 1, text, &mut position), (vec![], false));
    }

    #[test]
    fn files_stay_in_their_folder() {
        let mut output = Output::default();
        assert!(output.open("a.txt", "w").unwrap_err().contains("no folder"));
        output.folder = Some(std::env::temp_dir());
        for name in ["../a.txt", "/etc/passwd", ""] {
            assert!(output.open(name, "r").unwrap_err().contains("outside"), "{name}");
        }
        assert_eq!(output.open("no such file", "r"), Ok(-1.0));
        assert!(output.print_to(3.0, "x", &[]).is_err());
    }
}
