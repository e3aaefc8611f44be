// SPDX-License-Identifier: Apache-2.0
// Nothing of its own: what CMake precompiles for all tests is compiled with the flags of this program.
int main() {}
