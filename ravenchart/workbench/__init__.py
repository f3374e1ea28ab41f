"""The workbench: a model in a local web page, changed and analysed there."""
