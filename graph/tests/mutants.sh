#!/usr/bin/env bash
# Faults planted in the planner and the tracker, one line each: the property tests must notice every one of them.
#
#   graph/tests/mutants.sh [WORD]      all mutants, or those whose name contains WORD
#
# The crate is copied to a temporary folder, never changed in place. For each mutant the tests below run there, and one of them
# must fail; the table says which. It is an error if a mutant's old text is not in its file exactly once, if it does not compile,
# or if no test fails: then the tests have a hole, or the line does nothing.
#
# All runs draw the same pipelines, without a mutant too, so that what fails fails by the mutant. SEED chooses them, CASES says how
# many (default 1000); CARGO_TARGET_DIR is used if it is set. Not part of `cargo test`, since every mutant is a build. Accepted: a
# mutant that only a rare pipeline shows may survive a run with few cases.
set -euo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
only=${1:-}
export INCREMENTAL_CASES=${CASES:-1000}
export PROPTEST_RNG_SEED=${SEED:-1}
export CARGO_PROFILE_DEV_OPT_LEVEL=${OPT:-0}
tests=(-p luminaire-graph --test incremental --test planning_properties --test lessons)

copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
git -C "$root" ls-files -z | tar -C "$root" --null -T - -c | tar -C "$copy" -x
cd "$copy"
# Cargo knows files by their times: what an earlier run built from a mutant must not count as built from these.
find . -name '*.rs' -exec touch {} +

# Replaces a text that stands in a file exactly once.
replace() {
    local file=$1 old=$2 new=$3 text rest
    text=$(cat "$file")
    rest=${text#*"$old"}
    if [[ "$rest" == "$text" ]]; then echo "not in $file: $old" >&2; return 1; fi
    if [[ "$rest" == *"$old"* ]]; then echo "several times in $file: $old" >&2; return 1; fi
    printf '%s\n' "${text%%"$old"*}$new$rest" > "$file"
}

count=0
errors=0
mutant() {
    local name=$1 file=graph/src/$2 log caught
    [[ "$name" == *"$only"* ]] || return 0
    count=$((count + 1))
    cp "$file" "$copy/original"
    if ! replace "$file" "$3" "$4"; then
        printf 'STALE     %s\n' "$name"
        errors=$((errors + 1))
        return 0
    fi
    if ! log=$(cargo test --quiet --no-run "${tests[@]}" 2>&1); then
        printf 'NO BUILD  %s\n%s\n' "$name" "$(grep -m 3 -A 4 '^error' <<< "$log")"
        errors=$((errors + 1))
    else
        log=$(timeout 300 cargo test --no-fail-fast "${tests[@]}" 2>&1) && caught= || caught=$?
        if [[ -z "$caught" ]]; then
            printf 'SURVIVED  %s\n' "$name"
            errors=$((errors + 1))
        elif [[ "$caught" == 124 ]]; then
            printf 'caught    %-48s (no end)\n' "$name"
        else
            printf 'caught    %-48s %s\n' "$name" "$(sed -n 's/^test \(.*\) \.\.\. FAILED$/\1/p' <<< "$log" | paste -sd ' ')"
        fi
    fi
    cp "$copy/original" "$file"
}

# A failure need not be small here.
replace graph/tests/incremental/main.rs 'max_shrink_iters: 3_000' 'max_shrink_iters: 0'
replace graph/tests/planning_properties.rs 'cases: 300,' 'cases: 300, max_shrink_iters: 0,'
cargo test --quiet "${tests[@]}" > /dev/null || { echo "the tests fail without a mutant" >&2; exit 1; }

# What runs before what, and what stays alive.
mutant 'no edge from a reader to who destroys' schedule/dag.rs \
    'add(Edge { from: to, to: destroyer.0, reason: Reason::Destroys, resource, at });' 'let _ = destroyer;'
mutant 'no edge from who remembers to writers' schedule/dag.rs \
    'add(Edge { from: pass(*recaller), to: pass(later), reason: Reason::Destroys, resource, at: Some(*recaller) });' \
    'let _ = (later, recaller);'
mutant 'no edge along modifiers' schedule/dag.rs \
    'add(Edge { from: pass(pair[0]), to: pass(pair[1]), reason: Reason::Value, resource, at: Some(pair[1]) });' 'let _ = pair;'
mutant 'what is remembered is culled' schedule/cull.rs \
    '.take_while(|(recaller, _)| *recaller == node)' '.take_while(|(recaller, _)| *recaller == node).take(0)'

# Who shares memory.
mutant 'a retained resource shares' allocate/model.rs 'retained.iter().map(Option::is_some).collect()' 'retained.iter().map(|_| false).collect()'
mutant 'a texture is taken a step early' allocate/textures.rs \
    '(range.end as u32, index)' '((range.end as u32 - 1).max(range.start as u32 + 1), index)'
mutant 'a buffer is taken a step early' allocate/strip.rs 'entry.steps.1 >= first' 'entry.steps.1 > first'
mutant 'amortised content is not retained' dirty/retention.rs 'note(piece.resource, Retained::Amortised);' 'let _ = piece;'

# Who makes what for whom.
mutant 'iterations touch the parts of all' dirty/flow.rs \
    '|(mips, layers)| Rect::new(mips, layers));' '|_| Rect::new(&used.mips, &used.layers));'
mutant 'layers of a part are ignored' dirty/cells.rs \
    '(at(&self.layers, rect.layers.0), at(&self.layers, rect.layers.1))' '(at(&self.layers, rect.layers.0).min(0), columns)'
mutant 'mip levels of a part are ignored' dirty/cells.rs \
    'let rows = at(&self.mips, rect.mips.0)..at(&self.mips, rect.mips.1);' \
    'let rows = at(&self.mips, rect.mips.0).min(0)..self.mips.len().saturating_sub(1);'
mutant 'producer and modifiers are no unit' dirty/flow.rs '.map(|maker| (first, *maker)));' '.map(|maker| (first, *maker)).take(0));'
mutant 'passes of an iteration are no unit' dirty/flow.rs '.chain(spread).collect();' '.chain(spread.take(0)).collect();'
mutant 'an earlier version counts as the last' dirty/flow.rs 'source.last &= place + 1 == chain.len();' 'let _ = place;'
mutant 'history closes no cycle' dirty/flow.rs 'graph.add_edge(at(*maker), at(*recaller), ());' 'let _ = (maker, recaller);'

# Who is due.
mutant 'an input is ignored' dirty/closure.rs 'if *seen != Some(*revision) {' 'if *seen != Some(*revision) && (input != 0 || seen.is_none()) {'
mutant 'modifiers are not due by what they modify' dirty/closure.rs \
    'self.reach(*modifier, Why::Reads { step, resource }, outside);' 'let _ = (modifier, outside, resource);'
mutant 'an every-frame pass is on change' dirty/closure.rs 'for node in &tracker.always {' 'for node in tracker.always.iter().take(0) {'
mutant 'who remembers is not due' dirty/closure.rs 'for node in &tracker.recalling {' 'for node in tracker.recalling.iter().take(0) {'
mutant 'an iteration more a frame' dirty/closure.rs 'take(rule.per_frame as usize)' 'take(rule.per_frame as usize + 1)'
mutant 'changes within a cycle start it anew' dirty/closure.rs \
    'let outside = self.flow.cycle_of[*reader as usize] != cycle;' 'let outside = self.flow.cycle_of[*reader as usize] <= u32::MAX;'
mutant 'accumulation is cleared every time' dirty/closure.rs \
    'if matches!(step.run, Run::Accumulate(_)) && run.accumulated > 0 {' 'if matches!(step.run, Run::Accumulate(0)) && run.accumulated > 0 {'

# What is pulled and filled.
mutant 'outputs pull nothing' dirty/pull.rs 'for source in &self.flow.outputs {' 'for source in self.flow.outputs.iter().take(0) {'
mutant 'content that was taken counts as held' dirty/pull.rs \
    'if last && self.tracker.held.pieces[piece as usize] && !self.is_taken(entry.resource) {' \
    'if last && self.tracker.held.pieces[piece as usize] {'
mutant 'later takers are not noticed' dirty/pull.rs \
    'filter(|(held, ..)| self.takes(resource, *held)).collect();' 'filter(|(held, ..)| self.takes(*held, *held)).collect();'
mutant 'everything taken is made again' dirty/pull.rs \
    'writer != held && place(writer).first < place(held).first && place(writer).overlaps(place(held))' \
    'writer != held && place(writer).first < u32::MAX'
mutant 'declared values are never set again' dirty/pull.rs \
    'if self.tracker.held.declared[resource.index()] && !self.is_taken(resource) {' 'if self.tracker.held.declared.len() > resource.index() {'
mutant 'declared values at the end are left out' execute.rs \
    'in &frame.last_fills {' 'in frame.last_fills.iter().take(0) {'

# What the tracker remembers.
mutant 'what was overwritten stays held' dirty/tracker.rs 'self.lose_content(*other);' 'let _ = other;'
mutant 'a failed frame leaves content held' dirty/tracker.rs 'for resource in touched {' 'for resource in touched.into_iter().take(0) {'
mutant 'a lost device holds everything' dirty/tracker.rs \
    '*self = Tracker { frames, ..Tracker::new(Arc::clone(&self.plan)) };' 'self.frames = frames;'
mutant 'lost accumulation goes on' dirty/tracker.rs 'for piece in &self.held.unheld_amortised {' 'for piece in self.held.unheld_amortised.iter().take(0) {'
mutant 'accumulation goes on after a change' dirty/tracker.rs 'self.gathered.insert(*node, 0);' 'let _ = node;'
mutant 'what goes on gathering is a habit' dirty/tracker.rs '!is_amortised(run(node)) || restarted(node)' '!is_amortised(run(node)) || *node < u32::MAX'
mutant 'one round for all' dirty/tracker.rs 'turn.remaining = rounds;' 'turn.remaining = rounds.min(1);'
mutant 'who just ran comes first' dirty/tracker.rs 'turn.since = now + 1;' 'turn.since = 0;'
mutant 'a changed resource is not remembered anew' dirty/tracker.rs \
    'if !recallers.is_empty() && self.writes(*node, resource) {' 'if recallers.is_empty() && self.writes(*node, resource) {'

# From plan to plan.
mutant 'memory of another extent is taken over' dirty/adopt.rs \
    '(resides && from.offset == to.offset && same_shape(&before.shape, &after.shape)).then_some' '(resides && from.offset == to.offset).then_some'
mutant 'memory of another place is taken over' dirty/adopt.rs \
    '(resides && from.offset == to.offset && same_shape(&before.shape, &after.shape)).then_some' \
    '(resides && same_shape(&before.shape, &after.shape)).then_some'
mutant 'a resize is no new maker' dirty/maker.rs \
    'self.of(format!("{} {:?} {:?}", resource.name, shape(plan, resource), resource.clear))' \
    'self.of(format!("{} {:?}", resource.name, shape(plan, resource).is_empty()))'
mutant 'other makers of what is read go unnoticed' dirty/adopt.rs \
    'same && signature(&self.flow, &old_keys, *old) == signature(&new.flow, &new_keys, node as u32)' 'same'
mutant 'what never ran counts as run' dirty/adopt.rs \
    'let Some(old) = old.filter(|old| !self.fresh.contains(old)) else { continue };' 'let Some(old) = *old else { continue };'
mutant 'a remade past goes unnoticed' dirty/adopt.rs 'if remade {' 'if remade && new.flow.nodes.is_empty() {'
mutant 'turns are forgotten' dirty/adopt.rs 'turns.insert(new.flow.unit_of[node as usize], *turn);' 'let _ = turn;'

printf '%d mutants, %d not caught\n' "$count" "$errors"
[[ "$errors" == 0 ]]
