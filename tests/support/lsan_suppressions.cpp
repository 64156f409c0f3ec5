// OSMesa 22.3 forgets a few hundred bytes with every context that is destroyed. Linked into test programs that draw.

extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libOSMesa\n"; }
