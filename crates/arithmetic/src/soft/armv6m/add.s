@ a + b and a − b: r0 and r1 in, r0 out; changes r1, r2, r3, r12 and the flags.
@
@ The number of greater magnitude, with exponent e, goes to r0; d is the difference of the exponents. Fractions stand at the top
@ of a word, 9 bits below them guard; the leading one of r0's number would be bit 32. What is shifted out of the lesser
@ number decides the rounding only where the guard bits below the rounding bit are zero: the sum is then nearer to one
@ side by less than what these tell.

    .syntax unified
    .pushsection .text.__aeabi_fadd,"ax",%progbits
    .p2align 2
    .thumb

    .weak __aeabi_fsub
    .type __aeabi_fsub,%function
    .thumb_func
__aeabi_fsub:
    movs r3, #1
    lsls r3, r3, #31
    eors r1, r3

    .weak __aeabi_fadd
    .type __aeabi_fadd,%function
    .thumb_func
__aeabi_fadd:
1:  lsls r2, r0, #1
    lsls r3, r1, #1
    cmp  r2, r3
    bhs  2f
    eors r0, r1
    eors r1, r0
    eors r0, r1
    lsls r2, r0, #1
    lsls r3, r1, #1
2:  lsrs r3, r3, #24
    beq  30f
    lsrs r2, r2, #24
    cmp  r2, #254               @ 254: the sum may overflow
    bhs  40f
    mov  r12, r1
    sbcs r2, r3                 @ d − 1: the comparison has cleared the carry
    bcc  20f
    movs r3, r0
    eors r3, r1
    bmi  10f

@ Equal signs, d ≥ 1.
    lsls r1, r1, #8
    ldr  r3, 50f
    orrs r1, r3
    lsrs r1, r2
    lsls r3, r0, #9
    adds r3, r1
    bcs  5f
    lsls r1, r3, #24
    beq  4f
3:  lsrs r0, r0, #23
    lsls r0, r0, #23
    lsrs r3, r3, #9             @ carry: the rounding bit
    adcs r0, r3
    bx   lr
4:  cmp  r2, #8                 @ Up to 8 nothing was shifted out.
    bhi  38f
7:  lsrs r0, r0, #23
    lsls r0, r0, #23
    lsrs r3, r3, #9
    bcs  9f
    adds r0, r3
    bx   lr
5:  lsls r1, r3, #23            @ The sum has a digit more.
    beq  6f
    lsrs r0, r0, #23
    adds r0, #1
    lsls r0, r0, #23
    lsrs r3, r3, #10
    adcs r0, r3
    bx   lr
6:  cmp  r2, #8
    bhi  38f
    movs r1, #1
    lsls r1, r1, #23
    adds r0, r1
    lsrs r3, r3, #1
    b    7b
9:  adcs r0, r3                 @ A tie: up, then to the even number.
    lsrs r0, r0, #1
    lsls r0, r0, #1
    bx   lr

@ b is zero or subnormal.
30: lsls r3, r1, #1
    bne  40f
    lsrs r3, r2, #24
    cmp  r3, #255
    beq  40f
    cmp  r2, #0
    bne  31f
    ands r0, r1                 @ Of two zeros negative only if both are.
31: bx   lr

38: cmp  r2, #26                @ Below a quarter of the last digit's half?
    blo  39f
    bx   lr
39: mov  r1, r12
40: push {{r4, lr}}
    bl   {every_case}
    pop  {{r4, pc}}

@ Unequal signs, d ≥ 1.
10: lsls r1, r1, #8
    ldr  r3, 50f
    orrs r1, r3
    lsrs r1, r2
    lsls r3, r0, #9
    subs r3, r1
    bcc  11f
    lsls r1, r3, #24
    beq  4b
    lsrs r0, r0, #23
    lsls r0, r0, #23
    lsrs r3, r3, #9
    adcs r0, r3
    bx   lr
11: bpl  22f                    @ The leading one was borrowed from.
    lsls r1, r3, #25
    beq  12f
    lsrs r0, r0, #23
    subs r0, #2                 @ r3 still holds its leading one, which adds 1.
    lsls r0, r0, #23
    lsrs r3, r3, #8
    adcs r0, r3
    bx   lr
12: cmp  r2, #8
    bhi  38b
    movs r1, #1
    lsls r1, r1, #23
    subs r0, r1
    lsls r3, r3, #1
    b    7b

@ Equal exponents.
20: movs r3, r0
    eors r3, r1
    bmi  21f
    subs r1, r1, r0             @ Of equal signs: a + (b − a)/2, and an exponent more.
    movs r3, #1
    lsls r3, r3, #23
    adds r0, r3
    movs r3, r1
    asrs r3, r3, #1
    bcs  9b
    adds r0, r3
    bx   lr
21: lsls r3, r0, #9
    lsls r1, r1, #9
    subs r3, r1
    beq  28f

@ r3 holds less than half, with its leading one, and is exact: up to 25 exponents less.
22: lsls r1, r0, #1
    lsrs r1, r1, #24
    cmp  r1, #26
    bls  39b
    lsrs r0, r0, #23
    lsrs r1, r3, #16
    bne  23f
    lsls r3, r3, #16
    subs r0, #16
23: lsrs r1, r3, #24
    bne  24f
    lsls r3, r3, #8
    subs r0, #8
24: lsrs r1, r3, #28
    bne  25f
    lsls r3, r3, #4
    subs r0, #4
25: lsrs r1, r3, #30
    bne  26f
    lsls r3, r3, #2
    subs r0, #2
26: lsrs r1, r3, #31
    bne  27f
    lsls r3, r3, #1
    subs r0, #1
27: subs r0, #2
    lsls r0, r0, #23
    lsrs r3, r3, #8
    adds r0, r3
    bx   lr
28: movs r0, #0
    bx   lr

    .p2align 2
50: .word 0x80000000
    .size __aeabi_fadd, . - __aeabi_fadd
    .popsection
