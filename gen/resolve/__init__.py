"""Forms to a `System`: every name looked up, every type known, every place kept."""
