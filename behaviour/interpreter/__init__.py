"""Charts executed as modelled, in virtual time, by docs/semantics.md."""
