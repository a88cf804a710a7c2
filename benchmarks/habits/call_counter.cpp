#include "benchmarks/habits/call_counter.h"

#include <dlfcn.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>

// glibc's own, for those who stand before it.
extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* block, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
void __libc_free(void* block);
}

namespace {

// Plain data without constructors: allocations come before any of these would run.
thread_local bool counting = false;
thread_local foresight::CallCounts counts;
foresight::SystemCalls* system_calls = nullptr;

void count(long foresight::CallCounts::*what) {
  if (counting) ++(counts.*what);
}

// The library's function that this file's one stands before.
template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

template <typename Function>
struct Next {
  const char* name;
  Function* function = nullptr;

  Function* operator()() {
    if (function == nullptr) function = next<Function>(name);
    return function;
  }
};

Next<int(pthread_mutex_t*)> next_mutex_lock{"pthread_mutex_lock"};
Next<int(pthread_mutex_t*)> next_mutex_trylock{"pthread_mutex_trylock"};
Next<int(pthread_rwlock_t*)> next_read_lock{"pthread_rwlock_rdlock"};
Next<int(pthread_rwlock_t*)> next_write_lock{"pthread_rwlock_wrlock"};
Next<void(void*, void*, void (*)(void*))> next_throw{"__cxa_throw"};

#if defined(__x86_64__)
constexpr unsigned kMachine = AUDIT_ARCH_X86_64;
void fail_call(ucontext_t& context) { context.uc_mcontext.gregs[REG_RAX] = -ENOSYS; }
#elif defined(__aarch64__)
constexpr unsigned kMachine = AUDIT_ARCH_AARCH64;
void fail_call(ucontext_t& context) { context.uc_mcontext.regs[0] = static_cast<unsigned long long>(-ENOSYS); }
#else
constexpr unsigned kMachine = 0;
void fail_call(ucontext_t& /*context*/) {}
#endif

void on_system_call(int /*signal*/, siginfo_t* info, void* context) {
  if (system_calls->first < 0) system_calls->first = info->si_syscall;
  system_calls->count = system_calls->count + 1;
  fail_call(*static_cast<ucontext_t*>(context));
}

}  // namespace

extern "C" {

void* malloc(std::size_t bytes) {
  count(&foresight::CallCounts::allocations);
  return __libc_malloc(bytes);
}
void* calloc(std::size_t items, std::size_t bytes) {
  count(&foresight::CallCounts::allocations);
  return __libc_calloc(items, bytes);
}
void* realloc(void* block, std::size_t bytes) {
  count(&foresight::CallCounts::allocations);
  return __libc_realloc(block, bytes);
}
void* memalign(std::size_t alignment, std::size_t bytes) {
  count(&foresight::CallCounts::allocations);
  return __libc_memalign(alignment, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) { return memalign(alignment, bytes); }
int posix_memalign(void** block, std::size_t alignment, std::size_t bytes) {
  *block = memalign(alignment, bytes);
  return *block == nullptr ? ENOMEM : 0;
}
void free(void* block) {
  if (block != nullptr) count(&foresight::CallCounts::frees);
  __libc_free(block);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  count(&foresight::CallCounts::locks);
  return next_mutex_lock()(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) {
  count(&foresight::CallCounts::locks);
  return next_mutex_trylock()(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) {
  count(&foresight::CallCounts::locks);
  return next_read_lock()(lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) {
  count(&foresight::CallCounts::locks);
  return next_write_lock()(lock);
}

[[noreturn]] void __cxa_throw(void* exception, void* type, void (*destructor)(void*)) {
  count(&foresight::CallCounts::exceptions);
  next_throw()(exception, type, destructor);
  std::abort();
}
}

namespace foresight {

void start_counting() {
  counts = {};
  counting = true;
}

const CallCounts& counted() { return counts; }

bool count_system_calls(SystemCalls& calls) {
  if (kMachine == 0) return false;
  system_calls = &calls;
  struct sigaction action {};
  action.sa_sigaction = on_system_call;
  action.sa_flags = SA_SIGINFO;
  if (sigaction(SIGSYS, &action, nullptr) != 0) return false;
  constexpr auto at = [](std::size_t offset) { return static_cast<unsigned>(offset); };
  std::array<sock_filter, 9> filter = {{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, at(offsetof(seccomp_data, arch))),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kMachine, 0, 5),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, at(offsetof(seccomp_data, nr))),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_exit_group, 4, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_exit, 3, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_rt_sigreturn, 2, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clock_gettime, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  }};
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

}  // namespace foresight
