// Kernels and phase functions in SIMD. Included once per target.
#if defined(VDBEAM_PHOTON_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VDBEAM_PHOTON_MATH_INL_H_
#undef VDBEAM_PHOTON_MATH_INL_H_
#else
#define VDBEAM_PHOTON_MATH_INL_H_
#endif

#include "math/ray.h"
#include "phase/phase_function.h"
#include "vdbeam/scene.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vdbeam {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D16 = hn::CappedTag<float, 16>;
using V16 = hn::Vec<D16>;
using I16 = hn::RebindToSigned<D16>;

/// A kernel as step * [s < 1] + (1 - s) (linear + square (1 - s)).
struct KernelPolynomial {
  float step = 0, linear = 0, square = 0;
};

/// Disc kernels as functions of s = d^2 / r^2, to be multiplied by 1 / r^2; each integrates to 1
/// over the disc: integral_0^1 k(s) pi ds = 1. Biweight: 3 / pi (1 - s)^2.
inline KernelPolynomial disc_polynomial(KernelShape shape) {
  switch (shape) {
  case KernelShape::constant:
    return {1 / pi, 0, 0};
  case KernelShape::epanechnikov:
    return {0, 2 / pi, 0};
  case KernelShape::biweight:
    return {0, 0, 3 / pi};
  }
  return {};
}

/// Ball kernels as functions of s = d^2 / r^2, to be multiplied by 1 / r^3; each integrates to 1
/// over the ball: integral_0^1 k(s) 2 pi sqrt(s) ds = 1.
inline KernelPolynomial ball_polynomial(KernelShape shape) {
  switch (shape) {
  case KernelShape::constant:
    return {3 / (4 * pi), 0, 0};
  case KernelShape::epanechnikov:
    return {0, 15 / (8 * pi), 0};
  case KernelShape::biweight:
    return {0, 0, 105 / (32 * pi)};
  }
  return {};
}

/// The kernel at 1 - s = `k`, 0 where k <= 0.
HWY_INLINE V16 kernel_value(const KernelPolynomial& kernel, V16 k) {
  const D16 d;
  const auto inside = hn::Gt(k, hn::Zero(d));
  const auto value =
      hn::MulAdd(k, hn::MulAdd(hn::Set(d, kernel.square), k, hn::Set(d, kernel.linear)),
                 hn::Set(d, kernel.step));
  return hn::IfThenElseZero(inside, value);
}

/// 1 + g^2 - 2 g cos, as PhaseTerm::distance.
template <class D>
HWY_INLINE hn::Vec<D> lobe_distance(D d, const PhaseTerm& term, hn::Vec<D> cosine) {
  const auto x = hn::NegMulAdd(hn::Set(d, term.side), cosine, hn::Set(d, 1.0f));
  return hn::MulAdd(hn::Set(d, term.slope), hn::Max(hn::Zero(d), x), hn::Set(d, term.base));
}

/// Value of a phase function and its derivative by the cosine.
template <class D>
HWY_INLINE void phase_line(D d, const PhaseFunction& phase, hn::Vec<D> cosine, hn::Vec<D>& value,
                           hn::Vec<D>& slope) {
  value = slope = hn::Zero(d);
  const auto one = hn::Set(d, 1.0f);
  for (int i = phase.coefficient_count() - 1; i >= 0; --i) {
    slope = hn::MulAdd(slope, cosine, value);
    value = hn::MulAdd(value, cosine, hn::Set(d, phase.coefficient(i)));
  }
  for (int i = 0; i < phase.lobe_count(); ++i) {
    const PhaseTerm& term = phase.term(i);
    const auto x = lobe_distance(d, term, cosine);
    const auto hg = hn::Div(hn::Set(d, term.scale), hn::Mul(x, hn::Sqrt(x)));
    const auto draine = hn::MulAdd(hn::Mul(hn::Set(d, term.alpha), cosine), cosine, one);
    value = hn::MulAdd(hg, draine, value);
    const auto steepness = hn::Div(hn::Set(d, 1.5f * term.slope * term.side), x);
    slope = hn::MulAdd(
        hg, hn::MulAdd(draine, steepness, hn::Mul(hn::Set(d, 2 * term.alpha), cosine)), slope);
  }
}

/// x^(-3/2) for normal x > 0, with a relative error below 5e-7. Made of operations that IEEE 754
/// rounds exactly, so that all machines agree: the CPU's approximate reciprocals differ between
/// vendors and vector widths.
template <class D>
HWY_INLINE hn::Vec<D> inverse_three_halves(D d, hn::Vec<D> x) {
  const hn::RebindToSigned<D> di;
  // Half the exponent, negated: x^(-1/2) to 3.5 % (Lomont 2003, "Fast inverse square root").
  const auto guess =
      hn::BitCast(d, hn::Sub(hn::Set(di, 0x5f3759df), hn::ShiftRight<1>(hn::BitCast(di, x))));
  const auto square = hn::Mul(guess, guess);
  // x^(-3/2) = guess^3 (1 - e)^(-3/2); the minimax polynomial on |e| < 0.0691 is off by 2.5e-7.
  const auto e = hn::NegMulAdd(x, square, hn::Set(d, 1.0f));
  auto series = hn::MulAdd(hn::Set(d, 2.4652479f), e, hn::Set(d, 2.2033260f));
  series = hn::MulAdd(series, e, hn::Set(d, 1.8750280f));
  series = hn::MulAdd(series, e, hn::Set(d, 1.4999815f));
  series = hn::MulAdd(series, e, hn::Set(d, 1.0f));
  return hn::Mul(hn::Mul(square, guess), series);
}

template <class D>
HWY_INLINE hn::Vec<D> phase_value(D d, const PhaseFunction& phase, hn::Vec<D> cosine) {
  const auto one = hn::Set(d, 1.0f);
  auto value = hn::Zero(d);
  for (int i = phase.coefficient_count() - 1; i >= 0; --i)
    value = hn::MulAdd(value, cosine, hn::Set(d, phase.coefficient(i)));
  for (int i = 0; i < phase.lobe_count(); ++i) {
    const PhaseTerm& term = phase.term(i);
    const auto x = lobe_distance(d, term, cosine);
    auto lobe = hn::Mul(hn::Set(d, term.scale), inverse_three_halves(d, x));
    if (term.alpha != 0)
      lobe = hn::Mul(lobe, hn::MulAdd(hn::Mul(hn::Set(d, term.alpha), cosine), cosine, one));
    value = hn::Add(value, lobe);
  }
  return value;
}

} // namespace HWY_NAMESPACE
} // namespace vdbeam
HWY_AFTER_NAMESPACE();

#endif
