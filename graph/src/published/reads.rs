//! What is read of the rows of a table: all of it, or some members alone.
//!
//! A pass depends on what its shader reads, so that a change of the camera's exposure leaves a pass alone that asks for its place.

use std::fmt;

use super::TableMember;

/// What is read of every row of a table (of the one row, where the table is a uniform).
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum RowReads {
    /// All of it.
    Whole,
    /// These members alone, by offset. There may be none: the table's length alone counts.
    Members(Vec<ReadMember>),
}

/// A member of a row.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ReadMember {
    /// Its first byte.
    pub offset: u32,
    /// The byte after its last one.
    pub end: u32,
    /// Its name.
    pub name: String,
}

impl RowReads {
    /// Adds what someone else reads.
    pub fn add(&mut self, other: &RowReads) {
        match (&mut *self, other) {
            (RowReads::Members(members), RowReads::Members(others)) => {
                members.extend(others.iter().cloned());
                members.sort_unstable();
                members.dedup();
            }
            _ => *self = RowReads::Whole,
        }
    }

    /// The same, as `Whole` where every member of the table is read.
    pub fn of_table(self, table: &[TableMember]) -> RowReads {
        let read =
            |member: &TableMember| matches!(&self, RowReads::Members(known) if known.iter().any(|read| read.offset == member.offset));
        if !table.is_empty() && table.iter().all(read) { RowReads::Whole } else { self }
    }

    /// Whether two rows agree in what is read of them.
    pub fn agree(&self, a: &[u8], b: &[u8]) -> bool {
        let member = |member: &ReadMember| {
            let range = member.offset as usize..member.end as usize;
            a.get(range.clone()) == b.get(range)
        };
        match self {
            RowReads::Whole => a == b,
            RowReads::Members(members) => a.len() == b.len() && members.iter().all(member),
        }
    }
}

/// What follows the name of a table: nothing, `.exposure`, or `.{forward, position}`.
impl fmt::Display for RowReads {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RowReads::Whole => Ok(()),
            RowReads::Members(members) => match members.as_slice() {
                [] => f.write_str(".length"),
                [one] => write!(f, ".{}", one.name),
                several => {
                    let names: Vec<&str> = several.iter().map(|member| member.name.as_str()).collect();
                    write!(f, ".{{{}}}", names.join(", "))
                }
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn members(names: &[(u32, &str)]) -> RowReads {
        RowReads::Members(
            names.iter().map(|(offset, name)| ReadMember { offset: *offset, end: offset + 4, name: (*name).to_owned() }).collect(),
        )
    }

    #[test]
    fn rows_agree_where_no_read_member_differs() {
        let reads = members(&[(4, "b")]);
        assert!(reads.agree(&[0, 0, 0, 0, 1, 1, 1, 1], &[9, 9, 9, 9, 1, 1, 1, 1]));
        assert!(!reads.agree(&[0, 0, 0, 0, 1, 1, 1, 1], &[0, 0, 0, 0, 1, 1, 1, 2]));
        assert!(!RowReads::Whole.agree(&[0], &[1]));
        assert!(!reads.agree(&[], &[0; 8]), "a row that is not there");
    }

    #[test]
    fn reads_add_up_to_the_whole() {
        let mut reads = members(&[(4, "b")]);
        reads.add(&members(&[(0, "a"), (4, "b")]));
        assert_eq!(reads, members(&[(0, "a"), (4, "b")]));
        assert_eq!(reads.to_string(), ".{a, b}");
        let table = |names: &[&str]| -> Vec<TableMember> {
            let member =
                |(index, name): (usize, &&str)| TableMember { name: (*name).to_owned(), wgsl: "f32".to_owned(), offset: 4 * index as u32 };
            names.iter().enumerate().map(member).collect()
        };
        assert_eq!(reads.clone().of_table(&table(&["a", "b"])), RowReads::Whole);
        assert_eq!(reads.clone().of_table(&table(&["a", "b", "c"])), reads);
        reads.add(&RowReads::Whole);
        assert_eq!(
            (reads.to_string(), members(&[(0, "a")]).to_string(), members(&[]).to_string()),
            (String::new(), ".a".to_owned(), ".length".to_owned())
        );
    }
}
