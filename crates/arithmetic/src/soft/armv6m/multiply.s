@ a · b: r0 and r1 in, r0 out; changes r2, r3 and the flags.
@
@ Served here are exponents from 64 to 191, whose two highest bits differ, that is magnitudes from 2⁻⁶³ up to 2⁶⁵. With the
@ fractions f, g (23 bits) the product of 1 + f and 1 + g has 32 bits behind its point in
@     2³² + 2⁹f + 2⁹g + fg/2¹⁴.
@ Processors of this architecture multiply 32 bits by 32 to 32. The upper 16 bits of f and g give fg but for less than 2³¹,
@ the product modulo 2³² gives that rest.

    .syntax unified
    .pushsection .text.__aeabi_fmul,"ax",%progbits
    .p2align 2
    .thumb

    .weak __aeabi_fmul
    .type __aeabi_fmul,%function
    .thumb_func
__aeabi_fmul:
    push {{r4, r5, lr}}
    lsls r2, r0, #1
    eors r2, r0
    lsls r3, r1, #1
    eors r3, r1
    ands r2, r3
    lsls r2, r2, #1
    bpl  20f
    lsrs r2, r0, #23
    lsrs r3, r1, #23
    adds r2, r3
    subs r2, #127               @ sign and exponent, and above them a carry of the signs
    uxtb r3, r2
    cmp  r3, #254               @ 254: the product may overflow
    bhs  20f

    lsls r0, r0, #9             @ 2⁹f
    lsls r1, r1, #9             @ 2⁹g
    lsrs r3, r0, #16
    lsrs r4, r1, #16
    muls r4, r3
    lsrs r3, r0, #9
    lsrs r5, r1, #9
    muls r5, r3
    lsls r3, r4, #14
    subs r5, r3                 @ what r4 lacks, times 2¹⁴
    lsrs r3, r5, #14
    adds r4, r3                 @ fg/2¹⁴
    adds r0, r1
    bcs  4f
    adds r0, r4
    bcs  5f

@ Product below 2.
    lsls r1, r0, #24
    beq  2f
1:  lsls r2, r2, #23
    lsrs r0, r0, #9             @ carry: the rounding bit
    adcs r0, r2
    pop  {{r4, r5, pc}}
2:  lsls r1, r5, #18            @ All bits below the rounding bit are zero?
    bne  1b
    lsls r2, r2, #23
    lsrs r0, r0, #9
    bcs  3f
    adds r0, r2
    pop  {{r4, r5, pc}}
3:  adcs r0, r2                 @ A tie: up, then to the even number.
    lsrs r0, r0, #1
    lsls r0, r0, #1
    pop  {{r4, r5, pc}}

@ Product from 2 to 3.
4:  adds r0, r4
    bcs  7f
5:  lsls r1, r0, #23
    beq  6f
    adds r2, #1
    lsls r2, r2, #23
    lsrs r0, r0, #10
    adcs r0, r2
    pop  {{r4, r5, pc}}
6:  adds r2, #1
    lsrs r0, r0, #1
    b    2b

@ Product from 3 to 4.
7:  lsls r1, r0, #23
    beq  8f
    lsls r2, r2, #1
    adds r2, #3
    lsls r2, r2, #22
    lsrs r0, r0, #10
    adcs r0, r2
    pop  {{r4, r5, pc}}
8:  adds r2, #1
    lsrs r0, r0, #1
    movs r1, #1
    lsls r1, r1, #31
    orrs r0, r1
    b    2b

20: lsls r2, r0, #1
    lsls r3, r1, #1
    cmp  r2, r3
    bhs  21f
    movs r4, r2
    movs r2, r3
    movs r3, r4
21: lsrs r2, r2, #24            @ the greater exponent
    cmp  r2, #255
    beq  22f
    cmp  r3, #0
    bne  22f
    eors r0, r1                 @ Zero times a finite number.
    lsrs r0, r0, #31
    lsls r0, r0, #31
    pop  {{r4, r5, pc}}
22: sub  sp, #4                 @ The stack is to be a multiple of 8.
    bl   {every_case}
    add  sp, #4
    pop  {{r4, r5, pc}}
    .size __aeabi_fmul, . - __aeabi_fmul
    .popsection
