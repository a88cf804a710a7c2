// Memory that stays: what one recognition needs, the next one uses again, so that a robot's program asks its operating
// system for none while it runs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <vector>

namespace foresight {

// Blocks of 16 bytes and more by size classes, four in each doubling, with a list of free blocks for each: segregated
// free lists (Wilson, Johnstone, Neely, Boles, "Dynamic Storage Allocation: A Survey and Critical Review", 1995).
// Blocks are cut from slabs, which the heap gives when nothing else fits, and which stay until the pool goes. Not for
// several threads at once.
class MemoryPool {
 public:
  struct Header;

  // reserve: taken from the heap at once. Unit: bytes.
  explicit MemoryPool(std::size_t reserve = 0);
  ~MemoryPool();
  MemoryPool(const MemoryPool&) = delete;
  MemoryPool& operator=(const MemoryPool&) = delete;

  // Aligned for any fundamental type and for 16-byte vectors. Throws std::bad_alloc when the heap has no more.
  [[nodiscard]] void* allocate(std::size_t bytes);
  void deallocate(void* block) noexcept;

  // All blocks are free: what was cut becomes whole again, so that the same requests in the same order find the same
  // places whatever came before. REQUIRES: every block was deallocated, else nothing happens.
  void start_over() noexcept;

  [[nodiscard]] std::size_t held() const { return held_; }  // of the heap. Unit: bytes.
  // Of the slabs, cut up at once since the pool last started over. Unit: bytes.
  [[nodiscard]] std::size_t used() const { return used_; }

  static constexpr std::size_t kAlignment = 16;

 private:
  struct Slab {
    std::byte* begin = nullptr;
    std::byte* next = nullptr;  // from here on it is uncut
    std::byte* end = nullptr;
  };
  static constexpr int kClassesPerDoubling = 4;
  static constexpr std::size_t kClasses = 160;  // up to 2^44 bytes

  [[nodiscard]] static std::size_t class_of(std::size_t bytes);  // the smallest that holds them
  [[nodiscard]] static std::size_t size_of(std::size_t size_class);
  [[nodiscard]] Header* cut(std::size_t size_class);
  void add_slab(std::size_t bytes);

  std::array<Header*, kClasses> free_{};
  std::vector<Slab> slabs_;
  std::size_t slab_ = 0;  // that blocks are cut from; those before it are used up
  std::size_t held_ = 0;
  std::size_t used_ = 0;
  std::size_t living_ = 0;  // blocks
};

// While it lives, what the calling thread makes with PoolAllocator comes from the pool; else from the heap. Scopes
// nest. At its end the pool starts over. What was made in it may go later, as long as the pool lives and no other
// thread uses it.
class PoolScope {
 public:
  explicit PoolScope(MemoryPool& pool);
  ~PoolScope();
  PoolScope(const PoolScope&) = delete;
  PoolScope& operator=(const PoolScope&) = delete;

 private:
  MemoryPool& pool_;
  MemoryPool* outer_;
};

namespace pool_detail {
[[nodiscard]] void* allocate(std::size_t bytes);
void deallocate(void* block) noexcept;
}  // namespace pool_detail

// For the standard library's containers. All are equal: a block knows where it came from.
template <typename T>
class PoolAllocator {
 public:
  using value_type = T;
  static_assert(alignof(T) <= MemoryPool::kAlignment);

  PoolAllocator() = default;
  template <typename Other>
  PoolAllocator(const PoolAllocator<Other>& /*other*/) noexcept {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(PTRDIFF_MAX) / sizeof(T)) throw std::bad_alloc();
    return static_cast<T*>(pool_detail::allocate(count * sizeof(T)));
  }
  void deallocate(T* block, std::size_t /*count*/) noexcept { pool_detail::deallocate(block); }

  friend bool operator==(const PoolAllocator& /*a*/, const PoolAllocator& /*b*/) { return true; }
};

// What recognition makes anew for each scan is made of these; what lives as long as a database is std::vector.
template <typename T>
using PoolVector = std::vector<T, PoolAllocator<T>>;
template <typename Key, typename T>
using PoolMap = std::map<Key, T, std::less<Key>, PoolAllocator<std::pair<const Key, T>>>;
template <typename Key>
using PoolSet = std::set<Key, std::less<Key>, PoolAllocator<Key>>;

}  // namespace foresight
