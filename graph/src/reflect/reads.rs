//! Which members of its uniform and storage variables an entry point reads.
//!
//! A variable that is a struct, or an array of structs, is followed through member accesses, loads of whole rows, and functions that
//! return a row. Members count if some expression names them, whether or not the value matters in the end. Every other use of a row (a
//! copy into a variable, an argument of a call) reads all members that the shader declares.
//!
//! Guarantees: what is left out can't be reached by the entry point. naga's count of references to each expression is held against the
//! references that are understood here, so that what is not understood is a read of everything.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{AddressSpace, ArraySize, Block, Expression, Function, GlobalVariable, Handle, Module, Statement, Type, TypeInner};

/// Members by index; `None` is all of them.
type Members = Option<BTreeSet<u32>>;

/// What a function reads, through what it calls as well.
#[derive(Debug, Clone, Default)]
pub(super) struct Reads {
    members: BTreeMap<Handle<GlobalVariable>, Members>,
    /// It returns a row of this variable, as it is.
    returns: Option<Handle<GlobalVariable>>,
}

/// Where an expression stands.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    /// An array of structs.
    Rows(Handle<GlobalVariable>),
    /// A struct: a place in memory, or its value.
    Row(Handle<GlobalVariable>),
}

/// What every entry point reads, in the module's order. Needs a valid module.
pub(super) fn of_entries(module: &Module, info: &ModuleInfo) -> Vec<Reads> {
    let mut functions: HashMap<Handle<Function>, Reads> = HashMap::new();
    // A function calls only those before it.
    for (handle, function) in module.functions.iter() {
        let reads = Walk::new(module, function, &info[handle], &functions).finish(true);
        functions.insert(handle, reads);
    }
    let entry = |(index, entry): (usize, &naga::EntryPoint)| {
        Walk::new(module, &entry.function, info.get_entry_point(index), &functions).finish(false)
    };
    module.entry_points.iter().enumerate().map(entry).collect()
}

impl Reads {
    /// Indices of the members that are read of a variable; `None` is all.
    pub(super) fn members(&self, variable: Handle<GlobalVariable>) -> Option<impl Iterator<Item = usize>> {
        let members = self.members.get(&variable).cloned().unwrap_or_else(|| Some(BTreeSet::new()));
        members.map(|members| members.into_iter().map(|member| member as usize))
    }

    fn add(&mut self, variable: Handle<GlobalVariable>, members: Members) {
        let known = self.members.entry(variable).or_insert_with(|| Some(BTreeSet::new()));
        match (known.as_mut(), members) {
            (Some(known), Some(members)) => known.extend(members),
            _ => *known = None,
        }
    }
}

/// One function.
struct Walk<'a> {
    function: &'a Function,
    info: &'a FunctionInfo,
    /// By expression.
    places: Vec<Option<Place>>,
    /// By expression: references that are understood.
    understood: Vec<usize>,
    returned: Vec<Option<Handle<Expression>>>,
    reads: Reads,
}

impl<'a> Walk<'a> {
    fn new(module: &Module, function: &'a Function, info: &'a FunctionInfo, known: &HashMap<Handle<Function>, Reads>) -> Walk<'a> {
        let count = function.expressions.len();
        let mut walk =
            Walk { function, info, places: vec![None; count], understood: vec![0; count], returned: Vec::new(), reads: Reads::default() };
        walk.statements(&function.body, known);
        for (handle, expression) in function.expressions.iter() {
            walk.places[handle.index()] = walk.place(module, expression, known);
        }
        walk
    }

    fn place(&mut self, module: &Module, expression: &Expression, known: &HashMap<Handle<Function>, Reads>) -> Option<Place> {
        let of = |walk: &Walk<'_>, handle: Handle<Expression>| walk.places.get(handle.index()).copied().flatten();
        match *expression {
            Expression::GlobalVariable(variable) => {
                let declared = module.global_variables.try_get(variable).ok()?;
                if !matches!(declared.space, AddressSpace::Uniform | AddressSpace::Storage { .. }) {
                    return None;
                }
                let place = shape(module, declared.ty, variable);
                if place.is_none() {
                    self.reads.add(variable, None);
                }
                place
            }
            Expression::Access { base, .. } => self.step_into(base, of(self, base)?, None),
            Expression::AccessIndex { base, index } => self.step_into(base, of(self, base)?, Some(index)),
            Expression::Load { pointer } => match of(self, pointer)? {
                Place::Row(variable) => {
                    self.understood[pointer.index()] += 1;
                    Some(Place::Row(variable))
                }
                Place::Rows(_) => None,
            },
            // The length is no row.
            Expression::ArrayLength(array) => {
                self.understood[array.index()] += 1;
                None
            }
            Expression::CallResult(function) => known.get(&function)?.returns.map(Place::Row),
            _ => None,
        }
    }

    fn step_into(&mut self, base: Handle<Expression>, place: Place, index: Option<u32>) -> Option<Place> {
        match (place, index) {
            (Place::Rows(variable), _) => {
                self.understood[base.index()] += 1;
                Some(Place::Row(variable))
            }
            (Place::Row(variable), Some(member)) => {
                self.understood[base.index()] += 1;
                self.reads.add(variable, Some(BTreeSet::from([member])));
                None
            }
            (Place::Row(_), None) => None,
        }
    }

    /// What calls read, and what is returned.
    fn statements(&mut self, block: &Block, known: &HashMap<Handle<Function>, Reads>) {
        for statement in block {
            match statement {
                Statement::Block(block) => self.statements(block, known),
                Statement::If { accept, reject, .. } => {
                    self.statements(accept, known);
                    self.statements(reject, known);
                }
                Statement::Switch { cases, .. } => cases.iter().for_each(|case| self.statements(&case.body, known)),
                Statement::Loop { body, continuing, .. } => {
                    self.statements(body, known);
                    self.statements(continuing, known);
                }
                Statement::Return { value } => self.returned.push(*value),
                Statement::Call { function, .. } => {
                    for (variable, members) in known.get(function).into_iter().flat_map(|reads| &reads.members) {
                        self.reads.add(*variable, members.clone());
                    }
                }
                _ => {}
            }
        }
    }

    /// `hands_on`: a caller learns which row is returned.
    fn finish(mut self, hands_on: bool) -> Reads {
        let rows: Vec<_> = self.returned.iter().map(|value| self.places.get((*value)?.index()).copied().flatten()).collect();
        if let (true, [Some(Place::Row(first)), ..]) = (hands_on, rows.as_slice())
            && rows.iter().all(|row| *row == Some(Place::Row(*first)))
        {
            self.reads.returns = Some(*first);
            for value in self.returned.iter().flatten() {
                self.understood[value.index()] += 1;
            }
        }
        for (handle, _) in self.function.expressions.iter() {
            if let Some(Place::Row(variable) | Place::Rows(variable)) = self.places[handle.index()]
                && self.info[handle].ref_count > self.understood[handle.index()]
            {
                self.reads.add(variable, None);
            }
        }
        self.reads
    }
}

/// Whether a variable is a struct, or an array of structs.
pub(super) fn has_rows(module: &Module, variable: Handle<GlobalVariable>) -> bool {
    module.global_variables.try_get(variable).is_ok_and(|declared| shape(module, declared.ty, variable).is_some())
}

/// Where a variable of this type begins; `None` if it has no members to tell apart, or may end with an array of any length.
fn shape(module: &Module, ty: Handle<Type>, variable: Handle<GlobalVariable>) -> Option<Place> {
    let inner = |ty: Handle<Type>| module.types.get_handle(ty).ok().map(|ty| &ty.inner);
    match inner(ty)? {
        TypeInner::Struct { members, .. } => {
            let last = members.last().and_then(|last| inner(last.ty));
            let sized = !matches!(last, Some(TypeInner::Array { size: ArraySize::Dynamic, .. }));
            sized.then_some(Place::Row(variable))
        }
        TypeInner::Array { base, .. } => matches!(inner(*base)?, TypeInner::Struct { .. }).then_some(Place::Rows(variable)),
        _ => None,
    }
}
