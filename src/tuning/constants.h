#pragma once

#include "tuning/tuned.h"

#include <cstdint>

/// The fitted numbers of the method. None changes what a render converges to: each trades error
/// against time, and those of the error estimate the width of its interval against how often it
/// holds. A comment gives its unit and what it trades; docs/developer/tuning.md, whose table
/// tools/sensitivity.py writes, shows what changes where it is halved and doubled.
/// A new number needs a row there; a number whose row shows nothing is deleted.
namespace vdbeam::tuning {

// Costs: processor time [ns] of what renders count. Only ratios matter: they decide how work is
// shared out. Fitted to 39 scenes, where the ratio of two estimators came out right within 30 %;
// what walks' collisions and shadow rays cost, to scenes with up to 100 lamps.

/// A camera ray with its depth profile, and the query of the photon map of one of `beam`.
VDBEAM_TUNED(double, time_of_camera_ray, 10000);
/// A walk of `path` from a camera ray, and each tentative collision of a walk.
VDBEAM_TUNED(double, time_of_walk, 1000);
VDBEAM_TUNED(double, time_of_walk_collision, 40);
/// A shadow ray of such a walk, without its collisions.
VDBEAM_TUNED(double, time_of_walk_shadow_ray, 200);
/// A path from a surface.
VDBEAM_TUNED(double, time_of_surface_path, 2000);
/// A shadow ray through voxels; through layers, whose optical depth has a closed form.
VDBEAM_TUNED(double, time_of_ray_in_voxels, 5000);
VDBEAM_TUNED(double, time_of_ray_in_layers, 500);
/// A tentative collision of a light path, and a photon stored.
VDBEAM_TUNED(double, time_of_light_collision, 150);
VDBEAM_TUNED(double, time_of_photon, 2000);
/// Factor of what photons and their shadow rays cost by these, which overestimate it against a pass
/// of `path`.
VDBEAM_TUNED(double, time_of_photon_pass, 0.56);
/// Time of the most walks of final gathering over that of a pass that gathers along camera rays.
VDBEAM_TUNED(double, time_of_walks, 1.2);

// Light paths and photons.

/// Light paths per camera ray that shows photons' light: their noise against the time to trace
/// them. The fewest of a pass, and the most photons, which bounds memory.
VDBEAM_TUNED(double, paths_per_hit, 4);
VDBEAM_TUNED(double, fewest_paths, 10000);
VDBEAM_TUNED(double, most_photons, 4e6);
/// Factor, at most, by which a medium gets more light paths where each has less than one tentative
/// collision: the blur of photons that are few against the time to trace paths that meet little.
VDBEAM_TUNED(double, most_paths_in_thin_media, 4);
/// Photons stored per path, mean; more are nearly redundant.
VDBEAM_TUNED(double, stored_per_path, 4);
/// Light paths per photon that a scene asks for: in a medium so thin that more would be needed,
/// photons are few.
VDBEAM_TUNED(double, most_paths_per_photon, 16);
/// Where the camera sees nothing of a cell, collisions there are stored with at least this share of
/// the probability of those that it sees best: photons that bring nothing against rare bright ones.
VDBEAM_TUNED(float, least_importance, 1.0f / 64);
/// Photons of less importance than the inverse are thinned even where there are too few.
VDBEAM_TUNED(double, most_view_factor, 4);
/// Camera rays along the picture's longer side that find the importance of cells.
VDBEAM_TUNED(int, importance_rays_across, 96);
/// Area of a volume over that of all smaller ones together from which on these are a nest, at which
/// photons are aimed; and the factor by which extinctions within a part of the medium may differ:
/// photons of thin fog are bright in a cloud, those of many parts are few.
VDBEAM_TUNED(double, nest_area, 16);
VDBEAM_TUNED(float, widest_part, 8);
/// Weight windows (Booth and Hendricks 1984): a path that is worth less than the lowest value of
/// the mean is ended with a chance that brings survivors to the mean, but is no less than the least
/// one; a path that is worth more than the highest value is split in two.
VDBEAM_TUNED(float, lowest_window, 0.5f);
VDBEAM_TUNED(float, highest_window, 4);
VDBEAM_TUNED(float, least_window_chance, 0.25f);
/// Weight under which Russian roulette begins.
VDBEAM_TUNED(float, roulette_below, 0.1f);

// Kernels: photons in the sphere of an adaptive kernel's radius. Few have noise, many have bias.

/// Where no pilot chooses them; those on surfaces, and their greatest radius as a share of the
/// surfaces' size.
VDBEAM_TUNED(double, default_neighbours, 500);
VDBEAM_TUNED(double, surface_neighbours, 64);
VDBEAM_TUNED(double, widest_surface_kernel, 0.05);
/// Least radius of a disc that a surface cuts without a leak, in parts of what it is far from
/// surfaces: small ones are bright, wide ones blur more.
VDBEAM_TUNED(float, least_disc_before_surface, 0.5f);
/// Those of a kernel that walks gather in, over those of one along camera rays: the walks even out
/// some of the noise.
VDBEAM_TUNED(double, neighbours_of_gather, 0.5);
/// Those of a kernel of photons that mirrors and glass brought, where final gathering needs them.
VDBEAM_TUNED(float, caustic_neighbours, 8);
/// Photons of a cell that is searched for neighbours, in parts of a kernel's: the radius' accuracy
/// against the time to find it.
VDBEAM_TUNED(float, cell_of_neighbours, 1.0f / 16);
/// What a pilot may choose: the most, half of it and so on. Beyond the most, kernels are many mean
/// free paths wide and have a bias that the pilot does not show; with fewer than the fewest,
/// adaptive radii are no longer accurate.
VDBEAM_TUNED(double, most_neighbours, 1280);
VDBEAM_TUNED(double, fewest_neighbours, 32);
/// Bias grows with the neighbours to this power: 2 / 3 where kernels are small against all that
/// they blur, less where they are as wide.
VDBEAM_TUNED(double, bias_power, 0.5);
/// Prior of a scene, before the pilot: the best number of the clouds that were measured, and by how
/// many factors of two it differs among them (standard deviation).
VDBEAM_TUNED(double, usual_neighbours, 512);
VDBEAM_TUNED(double, usual_octaves, 1);
/// Passes for which noise and bias are balanced. Both fall alike as radii shrink.
VDBEAM_TUNED(int, balanced_passes, 32);

// Pilots: what is measured before the first pass, against the time that this takes.

/// Light paths of the first pilot, and of the one that is guided.
VDBEAM_TUNED(std::uint64_t, pilot_paths, 1024);
VDBEAM_TUNED(std::uint64_t, guided_pilot_paths, 1024);
/// Kernels are tried on maps of this share of a pass's light paths, but no more paths than the
/// most; where passes are small, of twice the share up to a few.
VDBEAM_TUNED(double, trial_share, 0.125);
VDBEAM_TUNED(double, few_trial_paths, 5000);
VDBEAM_TUNED(double, most_trial_paths, 40000);
VDBEAM_TUNED(int, trial_maps, 6);
/// Photons in the narrow kernels of the trial, for a whole pass; the wide ones hold more. They lie
/// about what is chosen in the end, so that little is extrapolated.
VDBEAM_TUNED(double, trial_neighbours, 600);
VDBEAM_TUNED(double, wide_over_narrow, 4);
/// A narrow kernel holds at most this share of a map, so that a wide one fits.
VDBEAM_TUNED(double, most_in_kernel, 1.0 / 16);
/// Photons from which a typical kernel's radius is found, by which importance falls off.
VDBEAM_TUNED(std::size_t, photons_for_radius, 8192);
/// Below this many photons per pass the trial is too noisy, and defaults are used.
VDBEAM_TUNED(double, fewest_for_trial, 100);
/// Tiles of 16 x 16 pixels at which trials look, and the pixels of them that other pilots use:
/// every 48th, or more where fewer than the fewest would remain, since a dark pixel among few could
/// outweigh the others.
VDBEAM_TUNED(int, trial_tiles, 120);
VDBEAM_TUNED(std::size_t, pixels_between_samples, 48);
VDBEAM_TUNED(std::size_t, fewest_trial_pixels, 64);
/// Part of the picture's mean brightness that is added to a pixel's in the weights of trials, as
/// 0.01 is in MRSE.
VDBEAM_TUNED(double, dark_offset, 0.03);
/// Light paths that fit the path guide: a share of a pass, within limits; photons at most, and
/// those without which no guide is fitted.
VDBEAM_TUNED(double, guide_share, 0.25);
VDBEAM_TUNED(double, fewest_guide_paths, 512);
VDBEAM_TUNED(double, most_guide_paths, 8192);
VDBEAM_TUNED(double, most_guide_photons, 1e6);
VDBEAM_TUNED(std::size_t, fewest_guide_photons, 256);
/// Cells with fewer visits take most of their value from those around them, steps of a light with
/// fewer paths from the others.
VDBEAM_TUNED(double, guide_prior_visits, 8);
VDBEAM_TUNED(double, guide_prior_paths, 32);
/// Shares of paths that begin as if nothing were known, evenly and by power: what the pilot missed
/// is found all the same.
VDBEAM_TUNED(double, guide_uniform_share, 0.1);
VDBEAM_TUNED(double, guide_power_share, 0.2);

// Medium that is hardly seen.

/// Opacity under which camera rays get walks, shadow rays and light paths in proportion to it, and
/// the medium around nests photons: in parts of the opacity that is typical of the image, and of
/// that of the nests.
VDBEAM_TUNED(float, faint_opacity, 0.003f);

// Final gathering.

/// Walks from each camera ray where the regression's radius is below 0.7 pixels, below 1.4, and
/// wider: a wide fit evens out the noise of few.
VDBEAM_TUNED(int, walks_of_narrow_fit, 12);
VDBEAM_TUNED(int, walks_of_middle_fit, 8);
VDBEAM_TUNED(int, walks_of_wide_fit, 6);
/// Time of a pass of walks over that of one of `beam`, for the radius of the regression.
VDBEAM_TUNED(double, time_of_gather_pass, 1.5);
/// Scatterings of a walk at most: in very dense media kernels are far wider than walks could go.
VDBEAM_TUNED(int, most_scatterings_of_walk, 8);
/// Share of first directions that are drawn evenly where a forward peak is taken out: the smooth
/// rest by which the camera sees may be negative, where the table of directions has next to none.
VDBEAM_TUNED(float, evenly_drawn, 0.25f);
/// Difference in depth at which a neighbouring pixel does not count in the regression, over half
/// the width of what is shared.
VDBEAM_TUNED(float, deepest_over_width, 8);
/// Kernels have blurred already what the pilot sees: factor of the regression's squared bias.
VDBEAM_TUNED(double, blur_of_walks, 1.5);
/// Final gathering is used unless its forecast error is this factor above that without, times the
/// share of light that does not come from lamps in the medium: its forecast comes from few pixels,
/// and leaves out that walks even out other noise, too.
VDBEAM_TUNED(double, preference_for_gather, 4);

// Forward peaks (delta-M): bias against noise.

/// Largest fraction of the scattering that the first order may remove, along rays and in final
/// gathering. With more, light that is scattered twice by small angles is too dark.
VDBEAM_TUNED(float, largest_first_peak, 0.6f);
VDBEAM_TUNED(float, largest_peak_of_gather, 0.55f);
/// Optical depth from which on the first order is the lowest.
VDBEAM_TUNED(double, depth_of_lowest_order, 24);
/// The order of every second pass is higher by this step: a greater one would show the bias of
/// truncation with less noise, and cost more noise of the image.
VDBEAM_TUNED(int, order_step, 2);

// Direct light.

/// Sets of shadow rays per camera ray: this number over 1 plus the scattering events, within
/// limits. Where the medium is thin, single scattering is most of the light.
VDBEAM_TUNED(double, direct_per_collision, 12);
VDBEAM_TUNED(int, fewest_direct_samples, 2);
VDBEAM_TUNED(int, most_direct_samples, 6);
/// Factor of these where rays cross shafts of light: this times the relative deviation of what one
/// shadow ray finds, up to the most.
VDBEAM_TUNED(float, effort_in_shafts, 2);
VDBEAM_TUNED(float, most_effort_in_shafts, 8);
/// Optical depth before which no shadow ray ends at random.
VDBEAM_TUNED(float, certain_depth, 3);
/// The part of the mean light that each piece of a ray gets: what a shadow lattice may have missed.
VDBEAM_TUNED(float, lit_everywhere, 0.05f);
/// Radius of the shell around a lamp in which flights of walks look for its light (LampShells): in
/// optical depth, and at most this part of the medium's radius.
VDBEAM_TUNED(double, depth_of_lamp_shell, 0.5);
VDBEAM_TUNED(double, widest_lamp_shell, 0.25);
/// Lamps that the shadow rays of a vertex, or of a flight that passes lamps, look for at most
/// (LightDraw).
VDBEAM_TUNED(int, lamps_per_vertex, 8);
/// A light that shines on less than this part of a ray is sampled by its nearness.
VDBEAM_TUNED(float, small_lit_part, 0.5f);

// Edges, which several rays see.

/// Differences among the pixels around: of opacity; of the depth of those that are at least so
/// opaque, in widths of a pixel there.
VDBEAM_TUNED(float, uneven_opacity, 0.3f);
VDBEAM_TUNED(float, uneven_widths, 8);
/// An edge of light has at least this step, in parts of the brightest pixel, and differs from a
/// plane by less than this part of the step: shadows and outlines are noticed, noise is not.
VDBEAM_TUNED(float, least_step_of_light, 0.4f);
VDBEAM_TUNED(float, most_noise_of_step, 0.3f);

// Surfaces.

/// Squared relative error of a pixel at which one set of shadow rays, or one path, is enough, and
/// the most of them.
VDBEAM_TUNED(float, error_of_matt_light, 0.015f);
VDBEAM_TUNED(int, most_matt_samples, 16);
/// How many times the variance of its samples a difference of glossy light from a plane may have to
/// count as noise: few samples of a narrow lobe show less variance than they have.
VDBEAM_TUNED(float, gloss_tolerance, 4);
/// Variance that a plane leaves of the noise of the pixels to which it is fitted.
VDBEAM_TUNED(float, left_by_plane, 0.1f);
/// Pixels to each side by which noise on a surface is judged.
VDBEAM_TUNED(int, reach_of_effort, 2);
/// Cosine between normals at which a neighbour does not count in the fit of a surface.
VDBEAM_TUNED(float, least_cosine_of_fit, 0.9f);
/// Rays that look for lamps behind rough glass and gather nothing else.
VDBEAM_TUNED(int, lamp_rays, 12);

// Path tracing.

/// Branches towards narrow lights per scattering, before those that go elsewhere are left out, and
/// share of the directions of gather's walks about a lamp that has all the power; the distance from
/// a lamp in the medium up to which walks branch towards it [radii of its shell]; how much more
/// than on average a phase function must scatter straight on to be worth branches towards other
/// lights; the importance of a direction per value of the phase function about the light [sr]; the
/// weight, in parts of that with which a walk began, under which roulette begins where walks branch
/// in peaks.
VDBEAM_TUNED(float, branches_per_scattering, 0.25f);
VDBEAM_TUNED(double, reach_of_branches, 8);
VDBEAM_TUNED(float, sharp_peak, 200);
VDBEAM_TUNED(float, importance_of_peak, 10);
VDBEAM_TUNED(float, roulette_of_branches_below, 0.6f);
/// Share of the draws' variance that camera rays have at least: a few rays do not show less.
VDBEAM_TUNED(double, least_share_of_rays, 0.05);

// The choice of `auto`.

/// Passes after which estimators are compared: the lead of photons shrinks as passes are added,
/// since the bias of kernels falls more slowly than noise.
VDBEAM_TUNED(int, passes_compared, 16);
/// Renders of each trial pixel, by which their noise is measured.
VDBEAM_TUNED(int, trial_passes, 4);
/// `path` must be ahead by this factor: a few pixels miss its rarest and brightest paths.
VDBEAM_TUNED(double, safe_lead, 1.25);
/// Collisions of a light path beyond which `path` is taken without a trial.
VDBEAM_TUNED(double, most_collisions_per_path, 4096);
/// Photons stored per light path below which `path` is taken: where a kernel pilot showed what they
/// are worth, and where none did.
VDBEAM_TUNED(double, rarest_photons, 1.0 / 1000);
VDBEAM_TUNED(double, rarest_photons_without_pilot, 1.0 / 20);

// The error estimate: how wide its interval is against how often the interval holds the error.

/// The least share of a pixel's mean that its other batches may claim it has: without it, one batch
/// that has all of a pixel's light would weigh as if the pixel were black. Weight of a pixel's
/// neighbours beside these batches [batches].
VDBEAM_TUNED(double, least_mean_of_others, 0.4);
VDBEAM_TUNED(double, weight_of_neighbours, 0.5);
/// Relative uncertainty of the noise because weights are estimated themselves.
VDBEAM_TUNED(double, uncertainty_of_weights, 0.03);
/// Relative error of the squared bias estimated by narrower kernels, and the bias that they may
/// miss altogether, as a fraction of the noise.
VDBEAM_TUNED(double, uncertainty_of_blur, 1);
VDBEAM_TUNED(double, unseen_bias, 0.25);
/// The positive part of a noisy square is too large on average. It is shrunk by this many times its
/// squared error over itself: 1 as James and Stein do. Bias found by path-traced rays alone, or by
/// the truncation, counts only if it is significant.
VDBEAM_TUNED(double, shrinkage_of_blur, 1);
VDBEAM_TUNED(double, shrinkage_of_probes, 2);
/// Standard deviation, relative to the known error, that the bias not yet seen has beforehand.
/// Without it the interval of a few rays ends at tens of times the error.
VDBEAM_TUNED(double, expected_bias, 1);
/// A pixel's weight is found without its blur. A blur of this many standard errors is subtracted by
/// half, and so is a blur whose standard error is this share of the mean: weights that followed the
/// noise would be too large. The least share of the mean that is left without its blur.
VDBEAM_TUNED(double, half_believed_blur, 2);
VDBEAM_TUNED(double, half_believed_share, 0.1);
VDBEAM_TUNED(double, least_unblurred, 0.25);

} // namespace vdbeam::tuning
