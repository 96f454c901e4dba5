// Nothing: the headers are precompiled for it, and the libraries reuse them.
