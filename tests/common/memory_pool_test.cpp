#include "common/memory_pool.h"

#include <gtest/gtest.h>

#include <cstring>
#include <thread>

#include "common/random.h"

namespace foresight {
namespace {

// Blocks of random sizes, freed in random order, each filled with a byte of its own.
struct Block {
  unsigned char* bytes;
  std::size_t size;
  unsigned char mark;
};

std::size_t random_size(Random& random) {
  return static_cast<std::size_t>(std::exp2(random.uniform() * 17.0));  // 1 byte to 128 KiB
}

void expect_marked(const Block& block) {
  for (std::size_t i = 0; i < block.size; ++i) ASSERT_EQ(block.bytes[i], block.mark);
}

void use_and_free(MemoryPool& pool, std::uint64_t seed, int count) {
  Random random(seed, 0);
  std::vector<Block> blocks;
  for (int i = 0; i < count; ++i) {
    const std::size_t size = random_size(random);
    Block block{static_cast<unsigned char*>(pool.allocate(size)), size, static_cast<unsigned char>(i)};
    std::memset(block.bytes, block.mark, size);
    blocks.push_back(block);
    if (random.uniform() < 0.5) {
      const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(blocks.size()));
      expect_marked(blocks[at]);
      pool.deallocate(blocks[at].bytes);
      blocks.erase(blocks.begin() + static_cast<std::ptrdiff_t>(at));
    }
  }
  for (const Block& block : blocks) {
    expect_marked(block);
    pool.deallocate(block.bytes);
  }
}

TEST(MemoryPool, blocks_do_not_overlap) {
  MemoryPool pool;
  use_and_free(pool, 1, 2000);
}

TEST(MemoryPool, aligns_every_block) {
  MemoryPool pool;
  std::vector<void*> blocks;
  for (std::size_t size = 0; size < 300; ++size) {
    blocks.push_back(pool.allocate(size));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(blocks.back()) % MemoryPool::kAlignment, 0U) << size;
  }
  for (void* block : blocks) pool.deallocate(block);
}

TEST(MemoryPool, needs_no_more_for_what_it_held_before) {
  MemoryPool pool;
  use_and_free(pool, 2, 1000);
  pool.start_over();
  use_and_free(pool, 3, 1000);
  pool.start_over();
  const std::size_t held = pool.held();
  for (const std::uint64_t seed : {3, 2, 3, 3, 2}) {
    use_and_free(pool, seed, 1000);
    pool.start_over();
    EXPECT_EQ(pool.held(), held);
  }
}

TEST(MemoryPool, puts_the_same_requests_in_the_same_places_whatever_came_before) {
  MemoryPool pool(1U << 20);
  void* const first = pool.allocate(1000);
  pool.deallocate(first);
  pool.start_over();
  use_and_free(pool, 4, 50);
  pool.start_over();
  void* const again = pool.allocate(1000);
  EXPECT_EQ(again, first);
  pool.deallocate(again);
}

TEST(MemoryPool, uses_a_freed_block_again) {
  MemoryPool pool;
  void* const block = pool.allocate(5000);
  const std::size_t used = pool.used();
  pool.deallocate(block);
  EXPECT_EQ(pool.allocate(4900), block);
  EXPECT_EQ(pool.used(), used);
  pool.deallocate(block);
}

TEST(MemoryPool, takes_its_reserve_at_once_and_no_more_while_it_lasts) {
  constexpr std::size_t kReserve = 3U << 20;
  MemoryPool pool(kReserve);
  EXPECT_EQ(pool.held(), kReserve);
  void* const block = pool.allocate(kReserve / 2);
  EXPECT_EQ(pool.held(), kReserve);
  EXPECT_GE(pool.used(), kReserve / 2);
  void* const large = pool.allocate(kReserve);
  EXPECT_GT(pool.held(), kReserve);
  pool.deallocate(block);
  pool.deallocate(large);
}

TEST(MemoryPool, does_not_start_over_under_living_blocks) {
  MemoryPool pool;
  auto* const block = static_cast<unsigned char*>(pool.allocate(64));
  pool.start_over();
  void* const other = pool.allocate(64);
  EXPECT_NE(other, block);
  pool.deallocate(block);
  pool.deallocate(other);
}

TEST(MemoryPool, refuses_more_than_there_can_be) {
  MemoryPool pool;
  EXPECT_THROW((void)pool.allocate(std::size_t{1} << 60), std::bad_alloc);
  EXPECT_THROW((void)PoolAllocator<double>().allocate(std::size_t{1} << 61), std::bad_alloc);
  use_and_free(pool, 5, 100);  // and goes on
}

TEST(PoolScope, gives_containers_the_pool_of_their_thread) {
  MemoryPool pool;
  const PoolVector<int> outside(1000);
  EXPECT_EQ(pool.used(), 0U);
  {
    const PoolScope scope(pool);
    const PoolVector<int> inside(1000);
    EXPECT_GE(pool.used(), 4000U);
    const std::size_t used = pool.used();
    std::thread([] { const PoolVector<int> elsewhere(100000); }).join();
    EXPECT_EQ(pool.used(), used);
  }
  EXPECT_EQ(pool.used(), 0U);
}

TEST(PoolScope, lets_what_was_made_in_it_go_later) {
  MemoryPool pool;
  PoolVector<int> kept;
  PoolVector<int> given = {1, 2, 3};
  {
    const PoolScope scope(pool);
    kept.assign(1000, 7);
    kept.swap(given);  // of the heap inside, of the pool outside
  }
  EXPECT_EQ(given, PoolVector<int>(1000, 7));
  EXPECT_EQ(kept, (PoolVector<int>{1, 2, 3}));
  given = {};
}

TEST(PoolScope, nests) {
  MemoryPool outer;
  MemoryPool inner;
  const PoolScope scope(outer);
  {
    const PoolScope within(inner);
    const PoolVector<int> list(1000);
    EXPECT_EQ(outer.used(), 0U);
  }
  const PoolVector<int> list(1000);
  EXPECT_GE(outer.used(), 4000U);
  EXPECT_EQ(inner.used(), 0U);
}

}  // namespace
}  // namespace foresight
