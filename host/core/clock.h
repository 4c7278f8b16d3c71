/* clock.h: time. */
#ifndef CANDELA_CORE_CLOCK_H
#define CANDELA_CORE_CLOCK_H

/* Seconds of a clock that never jumps; only differences mean something. */
double clock_now(void);

/* Processor seconds of all threads of this process. */
double clock_cpu(void);

#endif
