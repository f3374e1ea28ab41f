"""Model files to checked forms: text, tree, schema. Nothing here knows what a form means."""
