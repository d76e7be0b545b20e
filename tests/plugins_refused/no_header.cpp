// An ordinary shared library.
extern "C" __attribute__((visibility("default"))) int acme_answer() { return 42; }
