// Nothing: the headers are precompiled for it, and tests reuse them.
