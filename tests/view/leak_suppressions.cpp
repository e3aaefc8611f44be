// SPDX-License-Identifier: Apache-2.0

/// Read by LeakSanitizer. cairo keeps the fonts it has resolved for the life of the process (about 1 kB, however many
/// pictures are made), where the sanitizer does not find them.
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig\n"; }
