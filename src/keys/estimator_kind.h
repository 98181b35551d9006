#pragma once

#include "vdbeam/render.h"

#include <memory>
#include <span>
#include <string_view>

namespace vdbeam {

class Estimator;
class PhotonPass;
struct EstimatorInput;

/// One estimator: everything that validation, plan, merge, help and docs ask about it. It stands in
/// the estimator's own file; the table below lists it.
struct EstimatorKind {
  std::string_view name; ///< as scene files call it
  std::string_view help; ///< one clause
  /// Whether the mean of its passes is the true picture whatever the scene. The bias of an
  /// estimator that shoots photons comes from their kernels: without photons it has none.
  bool unbiased = false;
  StageSet stages; ///< that it can run; the plan chooses among them
  /// Keys of [render] that only this estimator, and others that list them, read.
  std::span<const std::string_view> keys;
  /// `photons`: what traces and keeps the photons of a pass; null where it shoots none. Null itself
  /// for `auto`, which stands for others.
  std::unique_ptr<Estimator> (*make)(const EstimatorInput& input, PhotonPass* photons);

  bool shoots_photons() const { return stages.contains(Stage::photons); }
  /// Whether photons are gathered by walks from camera rays wherever that is possible, and whether
  /// they may be.
  bool gathers() const { return name == EstimatorType::gather.name; }
  bool may_gather() const { return gathers() || name == EstimatorType::automatic.name; }
};

/// Every estimator, in the order of --help. A new one is its file and a line here.
std::span<const EstimatorKind* const> estimator_table();

/// The estimator of a scene. Throws InputError for one that is not in the table.
const EstimatorKind& estimator_kind(const EstimatorType& type);

} // namespace vdbeam
