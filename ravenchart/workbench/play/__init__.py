"""Charts in motion: a model executed by the interpreter, step by step, in a local web page."""
