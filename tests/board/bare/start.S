/* SPDX-FileCopyrightText: Ravenchart contributors */
/* SPDX-License-Identifier: Apache-2.0 */

/* From reset to the main program, at the exception level where the emulator begins.
   Exceptions end the run with status 2, by semihosting. */

        .section .start, "ax"
        .globl  _start
_start:
        mrs     x0, currentel
        lsr     x0, x0, #2
        adr     x1, vectors
        cmp     x0, #3
        b.eq    3f
        cmp     x0, #2
        b.eq    2f
        msr     vbar_el1, x1
        b       1f
3:      msr     vbar_el3, x1
        msr     cptr_el3, xzr
        b       1f
2:      msr     vbar_el2, x1
        mov     x2, #0x33ff
        msr     cptr_el2, x2
1:      mov     x2, #(3 << 20)          /* floating point for all levels */
        msr     cpacr_el1, x2
        isb
        ldr     x0, =__stack_end
        mov     sp, x0
        ldr     x0, =__bss_start
        ldr     x1, =__bss_end
0:      cmp     x0, x1
        b.hs    4f
        str     xzr, [x0], #8
        b       0b
4:      bl      main
        mov     x0, #0
        b       board_exit

/* End the run with the status in x0. */
        .globl  board_exit
board_exit:
        adr     x1, exit_block
        str     x0, [x1, #8]
        mov     x0, #0x20               /* SYS_EXIT_EXTENDED */
        hlt     #0xf000
        b       .

        .balign 16
exit_block:
        .quad   0x20026                 /* ADP_Stopped_ApplicationExit */
        .quad   0

        .balign 2048
vectors:
        .rept   16
        mov     x0, #2
        b       board_exit
        .balign 128
        .endr
