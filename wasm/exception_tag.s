# SPDX-License-Identifier: Apache-2.0
# By which thrown C++ exceptions are known. Position-independent code leaves it to be defined elsewhere.
	.tagtype __cpp_exception i32
	.globl __cpp_exception
__cpp_exception:
