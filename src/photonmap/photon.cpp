#include "photonmap/photon.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace vdbeam {

namespace {

/// One array of all lists, `member`.
template <class T>
UnfilledArray<T> join(const std::vector<const PhotonList*>& lists,
                      UnfilledArray<T> PhotonList::*member) {
  std::vector<std::size_t> first{0};
  for (const PhotonList* list : lists)
    first.push_back(first.back() + (list->*member).size());
  UnfilledArray<T> all(first.back());
  tbb::parallel_for(std::size_t(0), lists.size(), [&](std::size_t i) {
    const UnfilledArray<T>& part = lists[i]->*member;
    std::copy(part.begin(), part.end(), all.begin() + static_cast<std::ptrdiff_t>(first[i]));
  });
  return all;
}

} // namespace

PhotonList join(const std::vector<const PhotonList*>& lists, int groups) {
  PhotonList all;
  all.position = join(lists, &PhotonList::position);
  all.direction = join(lists, &PhotonList::direction);
  all.power = join(lists, &PhotonList::power);
  all.first_flight = join(lists, &PhotonList::first_flight);
  all.group = join(lists, &PhotonList::group);
  all.groups = groups;
  all.part = join(lists, &PhotonList::part);
  all.path = join(lists, &PhotonList::path);
  return all;
}

} // namespace vdbeam
