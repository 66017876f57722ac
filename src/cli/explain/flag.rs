//! Flags of the commands, from the command line's own description.

use clap::CommandFactory;

use crate::cli::CommandLine;

/// A flag as some commands have it.
pub(super) struct Flag {
    /// Its name, without the dashes.
    pub name: String,
    /// Its value as the help shows it, such as ` N`; empty if the flag takes none.
    value: String,
    meaning: String,
    commands: Vec<String>,
}

/// The flags of all commands. If a flag has several meanings, it stands once for each.
pub(super) fn all() -> Vec<Flag> {
    let mut flags: Vec<Flag> = Vec::new();
    for command in CommandLine::command().get_subcommands() {
        let shown = command.get_arguments().filter(|argument| !argument.is_hide_set());
        for (name, argument) in shown.filter_map(|argument| Some((argument.get_long()?, argument))) {
            let meaning = argument.get_help().map(ToString::to_string).unwrap_or_default();
            let called = command.get_name().to_owned();
            if let Some(known) = flags.iter_mut().find(|flag| flag.name == name && flag.meaning == meaning) {
                known.commands.push(called);
                continue;
            }
            let takes_value = argument.get_action().takes_values();
            let value = argument.get_value_names().filter(|_| takes_value).and_then(|names| names.first());
            let value = value.map_or_else(String::new, |value| format!(" {value}"));
            flags.push(Flag { name: name.to_owned(), value, meaning, commands: vec![called] });
        }
    }
    flags
}

impl Flag {
    pub(super) fn told(&self) -> String {
        let commands: Vec<String> = self.commands.iter().map(|command| format!("`jostle {command}`")).collect();
        let commands = match &commands[..] {
            [one] => one.clone(),
            [first @ .., last] => format!("{} and {last}", first.join(", ")),
            [] => String::new(),
        };
        format!("`--{}{}` is a flag of {commands}: {}", self.name, self.value, self.meaning)
    }
}
