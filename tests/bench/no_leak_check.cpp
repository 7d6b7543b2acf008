// What AddressSanitizer, where tests are built with it, does in this program. Its search for leaks,
// at exit, follows all that looks like a pointer, and was seen to crash in Embree's memory after
// tests had passed. Other programs of the suite search for leaks in all code but that which calls
// Embree.

extern "C" const char* __asan_default_options();

extern "C" const char* __asan_default_options() {
    return "detect_leaks=0";
}
