"""What follows from a resolved system: distribution, tables, priorities, tasks, identifiers."""
