#pragma once

#include <array>

/// Published reflectances and transmittances of plane-parallel slabs with index-matched boundaries,
/// as printed (units of each table in its comment).
namespace vdbeam::slab {

/// Isotropic scattering, van de Hulst, "Multiple Light Scattering" vol. 1 (1980), Table 12, in the
/// six digits to which DISORT's test problem 1 (Stamnes, Tsay, Wiscombe, Jayaweera, Applied Optics
/// 27 (1988); disotest, checked there against that table) gives them for 16 streams, that is 8
/// half-range Gauss points.
struct IsotropicSlab {
  double thickness, albedo;
  bool beam;       ///< beam with mu0 = 0.1 and flux pi on the slab; else isotropic radiance 1
  double up, down; ///< diffuse flux out of the top and the bottom (for radiance 1: all of it)
  std::array<double, 3> radiance_up, radiance_down; ///< at mu = 0.1, 0.5, 1
};
inline constexpr std::array<IsotropicSlab, 6> isotropic_slabs{{
    {0.03125,
     0.2,
     true,
     7.99451e-02,
     7.94108e-02,
     {1.17771e-01, 2.64170e-02, 1.34041e-02},
     {1.15898e-01, 2.63324e-02, 1.33826e-02}},
    {0.03125,
     1.0,
     true,
     4.22922e-01,
     4.20233e-01,
     {6.22884e-01, 1.39763e-01, 7.09192e-02},
     {6.13458e-01, 1.39337e-01, 7.08109e-02}},
    {0.03125,
     0.99,
     false,
     9.06556e-02,
     3.04897,
     {1.33177e-01, 2.99879e-02, 1.52233e-02},
     {8.63946e-01, 9.69363e-01, 9.84447e-01}},
    {32,
     0.2,
     true,
     2.59686e-01,
     0,
     {2.62972e-01, 9.06967e-02, 5.02853e-02},
     {6.88840e-18, 1.30698e-17, 1.22980e-15}},
    {32,
     1.0,
     true,
     3.07390,
     6.76954e-02,
     {1.93321, 1.02732, 7.97199e-01},
     {1.16385e-02, 1.87805e-02, 2.71316e-02}},
    {32,
     0.99,
     false,
     2.49618,
     4.60048e-03,
     {8.77510e-01, 8.15136e-01, 7.52715e-01},
     {7.79280e-04, 1.26492e-03, 1.86840e-03}},
}};

/// Rayleigh scattering without polarisation, beam with mu0 = 0.080442 and flux 0.252716 (pi mu0) on
/// the slab: Sweigart, Astrophysical Journal Supplement 22 (1970), Table 1, as in DISORT's test
/// problem 2 (16 streams).
struct RayleighSlab {
  double thickness, albedo, up, down;
};
inline constexpr double rayleigh_mu0 = 0.080442;
inline constexpr std::array<RayleighSlab, 4> rayleigh_slabs{{
    {0.2, 0.5, 5.35063e-02, 4.41791e-02},
    {0.2, 1.0, 1.25561e-01, 1.06123e-01},
    {5.0, 0.5, 6.24730e-02, 2.51683e-04},
    {5.0, 1.0, 2.25915e-01, 2.68008e-02},
}};

/// Henyey-Greenstein, g = 0.75, albedo 1, normal incidence with flux pi: van de Hulst vol. 2
/// (1980), Table 37, as in DISORT's test problem 3 (16 streams, delta-M; fluxes good to four
/// digits).
struct HenyeyGreensteinSlab {
  double thickness, up, down; ///< diffuse fluxes
};
inline constexpr std::array<HenyeyGreensteinSlab, 2> henyey_greenstein_slabs{{
    {1, 2.47374e-01, 1.73849},
    {8, 1.59096, 1.54958},
}};

/// Henyey-Greenstein, g = 0.75, albedo 0.9, thickness 2, normal incidence: total reflectance and
/// transmittance (direct light included), van de Hulst vol. 2 (1980), Table 35, as in Wang, Jacques
/// and Zheng, "MCML", Computer Methods and Programs in Biomedicine 47 (1995).
inline constexpr double tissue_reflectance = 0.09739, tissue_transmittance = 0.66096;

/// H-function of conservative isotropic scattering at mu = 0.1, 0.2, ... 1: Chandrasekhar,
/// "Radiative Transfer" (1960), Table XI.
inline constexpr std::array<double, 10> h_conservative{1.2474, 1.4503, 1.6425, 1.8293, 2.0128,
                                                       2.1941, 2.3740, 2.5527, 2.7306, 2.9078};

} // namespace vdbeam::slab
