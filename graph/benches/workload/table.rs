//! Means by class of graphs, for people.

use std::collections::BTreeMap;

use super::baselines::BASELINES;

/// The figures of a graph.
pub struct Row {
    pub class: String,
    pub name: String,
    pub passes: usize,
    pub declared_bound: u64,
    /// Of the order in which everything is placed.
    pub bound: u64,
    pub placed: u64,
    pub allocated: u64,
    /// Microseconds to a plan.
    pub compile: f64,
    /// The same, with placing.
    pub placing: f64,
    /// Microseconds from a bound pipeline to a plan, which leaves out what reads the declarations.
    pub bound_to_plan: f64,
    /// Bytes and microseconds of each.
    pub baselines: Vec<(u64, f64)>,
}

fn mean(rows: &[&Row], figure: impl Fn(&Row) -> f64) -> f64 {
    rows.iter().map(|row| figure(row)).sum::<f64>() / rows.len() as f64
}

/// Prints to standard error.
pub fn print(rows: &[Row]) {
    let mut classes: BTreeMap<(usize, &str), Vec<&Row>> = BTreeMap::new();
    for row in rows {
        // The frame's sizes differ, and are told apart.
        let class = if row.class == "model" { &row.name } else { &row.class };
        classes.entry((row.passes, class)).or_default().push(row);
    }
    let of_declared = |row: &Row, bytes: u64| bytes as f64 / row.declared_bound as f64;
    eprintln!("bytes, means             bound/decl  placed/bound  placed/decl  alloc/decl  alloc/exact (worst)  | of the declared bound:");
    for ((_, class), rows) in &classes {
        let worst = rows.iter().map(|row| row.allocated as f64 / row.baselines[0].0 as f64).fold(0.0, f64::max);
        eprint!(
            "{class:<14} {:>4} graphs {:>9.3} {:>13.3} {:>12.3} {:>11.3} {:>12.3} ({worst:.3})  |",
            rows.len(),
            mean(rows, |row| of_declared(row, row.bound)),
            mean(rows, |row| row.placed as f64 / row.bound as f64),
            mean(rows, |row| of_declared(row, row.placed)),
            mean(rows, |row| of_declared(row, row.allocated)),
            mean(rows, |row| row.allocated as f64 / row.baselines[0].0 as f64),
        );
        for (index, (_, name)) in BASELINES.iter().enumerate() {
            eprint!("  {name} {:.3}", mean(rows, |row| of_declared(row, row.baselines[index].0)));
        }
        eprintln!();
    }
    eprintln!("ms, means                  from bound    plan  us/pass  and placed  | bound/exact  plan/exact  placed/exact  |");
    for ((passes, class), rows) in &classes {
        let exact = mean(rows, |row| row.baselines[0].1);
        let (compile, placing) = (mean(rows, |row| row.compile), mean(rows, |row| row.placing));
        eprint!(
            "{class:<14} {:>4} graphs {:>8.3} {:>8.3} {:>8.3} {:>9.3}  | {:>11.2} {:>11.2} {:>13.2}  |",
            rows.len(),
            mean(rows, |row| row.bound_to_plan) * 1e-3,
            compile * 1e-3,
            compile / *passes as f64,
            placing * 1e-3,
            mean(rows, |row| row.bound_to_plan) / exact,
            compile / exact,
            placing / exact
        );
        for (index, (_, name)) in BASELINES.iter().enumerate() {
            eprint!("  {name} {:.3}", mean(rows, |row| row.baselines[index].1) * 1e-3);
        }
        eprintln!();
    }
}
