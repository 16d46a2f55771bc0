//! What tests over the folder of assets share. The folder lies beside the repository; `LUMINAIRE_SHARED` names another one that
//! holds
//! `assets/`. Where it is missing the tests say 'ignored', and fail if `CI` is set.

use std::path::{Path, PathBuf};

use libtest_mimic::{Arguments, Trial};
use luminaire_graph::diagnostic::Diagnostic;

/// A test over the assets folder.
pub type AssetTest = fn(&Path);

/// The assets folder, if it is there.
fn assets() -> Option<PathBuf> {
    let shared =
        std::env::var_os("LUMINAIRE_SHARED").map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"), PathBuf::from);
    let assets = shared.join("assets");
    assets.join("MANIFEST.json").is_file().then_some(assets)
}

/// All messages, a line each, with their codes.
pub fn messages(diagnostics: &[Diagnostic]) -> String {
    diagnostics.iter().map(|diagnostic| format!("[{}] {}", diagnostic.code, diagnostic.message)).collect::<Vec<_>>().join("\n")
}

fn trial(name: &str, test: AssetTest, assets: Option<&Path>) -> Trial {
    match assets {
        Some(assets) => {
            let assets = assets.to_owned();
            Trial::test(name, move || {
                test(&assets);
                Ok(())
            })
        }
        None if std::env::var_os("CI").is_some() => Trial::test(name, || Err("the assets are missing, and CI must have them".into())),
        None => Trial::test(format!("{name} (the assets are missing)"), || Ok(())).with_ignored_flag(true),
    }
}

/// The whole of `main`.
pub fn run(tests: &[(&str, AssetTest)]) -> ! {
    let arguments = Arguments::from_args();
    let assets = assets();
    let trials = tests.iter().map(|(name, test)| trial(name, *test, assets.as_deref())).collect();
    libtest_mimic::run(&arguments, trials).exit()
}
