#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

namespace vdbeam {

/// Pixels of one task. Sums over the image are sums of blocks in order, whatever the threads.
inline constexpr std::size_t block_size = 4096;

/// Calls body(block, begin, end) for the pixels [begin, end) of each block, in parallel.
template <class Body>
void for_each_block(std::size_t pixels, const Body& body) {
  tbb::parallel_for(std::size_t{0}, (pixels + block_size - 1) / block_size, [&](std::size_t block) {
    body(block, block * block_size, std::min(pixels, (block + 1) * block_size));
  });
}

} // namespace vdbeam
