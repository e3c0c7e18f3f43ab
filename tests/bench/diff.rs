//! `diff` in fresh processes on the shipped specs, in a repository of their own: of equal states, and after the edit of one
//! node, which is built before. Equal ones are to take less than half a second, the other half a second more than the build.

use std::process::Command;

use super::super::Bench;
use super::build::Project;

fn repository() -> Project {
    let project = Project::built();
    project.write(".gitignore", "/.fretwork\n/out\n");
    let git = |arguments: &[&str]| {
        let mut command = Command::new("git");
        command
            .args(["-c", "user.name=a", "-c", "user.email=a@example.org"])
            .args(["-c", "commit.gpgsign=false"])
            .args(arguments)
            .current_dir(project.folder());
        let status = command.status().expect("git is installed");
        assert!(status.success(), "{arguments:?}");
    };
    git(&["init", "-q"]);
    git(&["add", "-A"]);
    git(&["commit", "-q", "-m", "shipped"]);
    project
}

/// Runs the benchmarks of this file.
pub fn run(bench: &Bench) {
    let compare = |project: &Project| {
        let text = project.run(&["diff", "HEAD"]);
        text.lines().last().unwrap_or_default().to_owned()
    };
    bench.run("diff of equal states", repository, compare);
    let edited = || {
        let project = repository();
        project.edit(|text| text.replace("flip: 50%", "flip: 40%"));
        project.build(&[]);
        project
    };
    bench.run("diff after the edit of one node", edited, compare);
    let thicker = || {
        let project = repository();
        project.edit_in("specs/framed-panel.yaml", |text| {
            text.replace("bar: { default: 2.4", "bar: { default: 2.8")
        });
        project.build(&[]);
        project
    };
    bench.run("diff of drawings and a solid", thicker, compare);
}
