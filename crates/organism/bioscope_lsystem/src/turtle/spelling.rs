//! Symbols of several letters that a string spells in modules of one: `@`, `G`, `s`.

use super::{
    TurtleOptions,
    command::{Command, command},
};
use crate::Alphabet;

/// Letters after `@` that another may follow.
const LONGER: &str = "PGTDb";
/// Symbols of three letters.
const LONG: [&str; 17] = [
    "@PS", "@PC", "@PD", "@Gs", "@Ge", "@Gc", "@Gr", "@Gt", "@Tx", "@Ts", "@Td", "@Tp", "@Tf",
    "@Di", "@Dd", "@bo", "@bc",
];

/// What has been spelled so far.
pub(super) struct Spelling {
    symbols: Vec<Box<str>>,
    begun: String,
}

impl Spelling {
    /// For an alphabet in which `@` or `~` is a module; none for others.
    pub fn of(alphabet: &Alphabet) -> Option<Self> {
        let symbols: Vec<Box<str>> =
            alphabet.kinds().iter().map(|kind| (&*kind.symbol).into()).collect();
        let spells = symbols.iter().any(|symbol| matches!(&**symbol, "@" | "~"));
        spells.then(|| Self { symbols, begun: String::new() })
    }

    /// Reads a module: the command of a symbol that ended before it, and what it means itself if
    /// that is not what it says alone.
    pub fn read(
        &mut self,
        code: u8,
        arity: u8,
        options: &TurtleOptions,
    ) -> (Option<Command>, Option<Command>) {
        let symbol = self.symbols.get(code as usize).map_or("", |symbol| symbol);
        let begun = std::mem::take(&mut self.begun);
        let whole = format!("{begun}{symbol}");
        match begun.len() {
            0 => {}
            1 if begun == "@" && arity == 0 && symbol.len() == 1 && LONGER.contains(symbol) => {
                self.begun = whole;
                return (None, Some(Command::Nothing));
            }
            1 => return (None, Some(command(&whole, arity, options))),
            _ if LONG.contains(&&*whole) => return (None, Some(command(&whole, arity, options))),
            _ => {}
        }
        let before = (begun.len() > 1).then(|| command(&begun, 0, options));
        if matches!(symbol, "@" | "~") && arity == 0 {
            self.begun = symbol.into();
            return (before, Some(Command::Nothing));
        }
        (before, None)
    }

    /// The command of a symbol that the string ends with.
    pub fn end(&mut self, options: &TurtleOptions) -> Option<Command> {
        let begun = std::mem::take(&mut self.begun);
        (begun.len() > 1).then(|| command(&begun, 0, options))
    }
}
