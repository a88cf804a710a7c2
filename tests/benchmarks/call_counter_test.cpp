#include "benchmarks/habits/call_counter.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <mutex>
#include <shared_mutex>
#include <stdexcept>
#include <vector>

namespace foresight {
namespace {

volatile int sink = 0;  // what the tests compute is of use to somebody

TEST(CallCounter, counts_nothing_where_nothing_is_done) {
  start_counting();
  for (int i = 0; i < 1000; ++i) sink = sink + i;
  const CallCounts counts = counted();
  EXPECT_EQ(counts.allocations + counts.frees + counts.locks + counts.exceptions, 0);
}

TEST(CallCounter, counts_what_is_allocated_and_freed_however_it_is_asked_for) {
  start_counting();
  {
    const std::vector<int> list(1000);
    sink = list[7];
  }
  EXPECT_EQ(counted().allocations, 1);
  EXPECT_EQ(counted().frees, 1);
  void* volatile block = std::malloc(10);  // volatile: compilers know malloc and leave out what nobody uses
  block = std::realloc(block, 1000);
  std::free(block);
  block = std::calloc(2, 3);
  std::free(block);
  void* aligned = nullptr;
  EXPECT_EQ(posix_memalign(&aligned, 64, 100), 0);
  std::free(aligned);
  std::free(nullptr);  // frees nothing
  const CallCounts counts = counted();
  EXPECT_EQ(counts.allocations, 5);
  EXPECT_EQ(counts.frees, 4);
}

TEST(CallCounter, counts_locks_that_nobody_contends) {
  std::mutex mutex;
  std::shared_mutex shared;
  start_counting();
  { const std::lock_guard lock(mutex); }
  { const std::unique_lock lock(mutex, std::try_to_lock); }
  { const std::shared_lock lock(shared); }
  { const std::unique_lock lock(shared); }
  EXPECT_EQ(counted().locks, 4);
}

TEST(CallCounter, counts_exceptions_and_lets_them_pass) {
  start_counting();
  try {
    throw std::runtime_error("one");
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "one");
  }
  EXPECT_EQ(counted().exceptions, 1);
}

TEST(CallCounter, counts_system_calls_and_denies_them) {
  auto* const calls = static_cast<SystemCalls*>(
      mmap(nullptr, sizeof(SystemCalls), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  ASSERT_NE(calls, MAP_FAILED);
  *calls = {};
  constexpr int kNoTraps = 3;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (!count_system_calls(*calls)) _exit(kNoTraps);
    const long answer = syscall(SYS_getppid);
    syscall(SYS_getuid);
    _exit(answer == -1 ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  const SystemCalls counts = *calls;
  munmap(calls, sizeof(SystemCalls));
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == kNoTraps) GTEST_SKIP() << "no seccomp here";
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(counts.count, 2);
  EXPECT_EQ(counts.first, SYS_getppid);
}

}  // namespace
}  // namespace foresight
