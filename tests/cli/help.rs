//! Help texts and versions of the program.

use super::harness::Folder;

#[test]
fn help_names_commands_examples_and_exit_codes() {
    let folder = Folder::new("help");
    let ended = folder.jostle("--help").code(0);
    for text in [
        "run ",
        "render ",
        "check ",
        "schema ",
        "jostle render example:tetris",
        "Exit codes: 0 good, 1 scene or",
        "kepler",
    ] {
        assert!(ended.out.contains(text), "{text}: {}", ended.out);
    }
    assert_eq!(folder.jostle("--version").code(0).out, concat!("jostle ", env!("CARGO_PKG_VERSION"), "\n"));
}

#[test]
fn help_of_a_command_names_its_flags() {
    let folder = Folder::new("help_flags");
    let shared = "--duration <T> --tick <DT> --method <NAME> --tolerance <X> --json";
    for (command, flags) in [
        ("run", "--output <channels.csv> --threads <N> --pace"),
        (
            "render",
            "--output <OUT> --at <T> --size <WxH> --fps <N> --threads <N> --quiet --png --strip <T,T,T> --sheet <4x3> --max-size <SIZE> --pace --theme <NAME> --layers <LAYER,LAYER>",
        ),
        ("check", "--run"),
    ] {
        let ended = folder.jostle(&format!("{command} --help")).code(0);
        for flag in format!("{shared} {flags}").split(" --") {
            assert!(ended.out.contains(&format!("--{}", flag.trim_start_matches('-'))), "{command}: {flag}");
        }
        assert!(ended.out.contains("Examples:\n  jostle "), "{command}");
        assert!(ended.out.contains("Auto,"), "{command} lists the methods");
    }
}
