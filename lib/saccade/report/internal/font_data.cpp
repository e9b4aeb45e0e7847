// SPDX-License-Identifier: Apache-2.0
// The font of the pictures, DejaVu Sans, as bytes: SACCADE_FONT_FILE is its path while building.
asm(".section .rodata\n"
    ".global saccade_font_begin\n"
    ".global saccade_font_end\n"
    ".balign 16\n"
    "saccade_font_begin:\n"
    ".incbin \"" SACCADE_FONT_FILE
    "\"\n"
    "saccade_font_end:\n"
    ".byte 0\n"
    ".previous\n");
