// Counts what a program on a robot must not do while it runs. Linked into a program, it stands before the C library's
// own functions: every allocation, lock and exception of the program and of the libraries it loads goes through it.
#pragma once

namespace foresight {

struct CallCounts {
  long allocations = 0;  // malloc and its like, and whatever is built on them, as operator new is
  long frees = 0;
  long locks = 0;  // of mutexes and read-write locks, taken or tried, contended or not
  long exceptions = 0;
};

// What the calling thread does from here on. Again: starts anew.
void start_counting();
[[nodiscard]] const CallCounts& counted();

struct SystemCalls {
  volatile long count = 0;
  volatile long first = -1;  // its number
};

// From here on each system call of this process is counted and denied, as if the kernel did not know it, but for those
// that end the process, that return from a signal and that read the clock (which mostly is none). There is no way back.
// calls: outlives the process's other work. Whether the kernel does it: by seccomp, Linux on x86-64 and arm64.
[[nodiscard]] bool count_system_calls(SystemCalls& calls);

}  // namespace foresight
