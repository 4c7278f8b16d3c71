/* vdb_cage.c: takes from a process what reading a file in memory does not need.
 *
 * Damage can make the library write past its buffers, and so, if someone meant it to, do anything
 * that the process may. After this, that is to compute, to use memory, and to write to pipes that
 * are open already (seccomp filter mode). Where the system has no such thing, the limits remain. */
#include <errno.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <stddef.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include "scene/vdb_pipe.h"

#if defined(__x86_64__)
#define ARCHITECTURE AUDIT_ARCH_X86_64
#elif defined(__aarch64__)
#define ARCHITECTURE AUDIT_ARCH_AARCH64
#endif

/* Sanitizers ask for more, to report. */
#if defined(ARCHITECTURE) && !defined(__SANITIZE_ADDRESS__)

#define LOAD(member) BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, member))
#define END(what) BPF_STMT(BPF_RET | BPF_K, what)
#define ALLOW(call) BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, __NR_##call, 0, 1), END(SECCOMP_RET_ALLOW)

/* Memory is what the C library takes; the rest is how a process reads a clock, hears signals and
 * ends. All else fails, as if it were forbidden. */
void vdb_cage(void) {
  struct sock_filter filter[] = {
      LOAD(arch),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, ARCHITECTURE, 1, 0),
      END(SECCOMP_RET_KILL_PROCESS),
      LOAD(nr),
      ALLOW(write),
      ALLOW(brk),
      ALLOW(mmap),
      ALLOW(munmap),
      ALLOW(mremap),
      ALLOW(madvise),
      ALLOW(mprotect),
      ALLOW(futex),
      ALLOW(sched_yield),
      ALLOW(clock_gettime),
      ALLOW(getrandom),
      ALLOW(rt_sigprocmask),
      ALLOW(rt_sigreturn),
      ALLOW(exit),
      ALLOW(exit_group),
      END(SECCOMP_RET_ERRNO | EPERM),
  };
  struct sock_fprog program = {sizeof filter / sizeof *filter, filter};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0)
    prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

#else

void vdb_cage(void) {}

#endif
