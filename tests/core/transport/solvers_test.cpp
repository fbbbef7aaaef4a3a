#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/photometry.h"
#include "core/transport/solve_gathering.h"
#include "core/transport/solve_progressive.h"
#include "tests/core/prepared_scene.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

using test::PreparedScene;

constexpr std::size_t kRoomy = std::size_t{1} << 30U;

/// Patches inside a sphere: F_ij = A_j / (area of the sphere), from everywhere. A share may be open to the sky.
struct Sphere final : RowSource {
  Patches patches;
  float open_share = 0.0F;

  Sphere(std::vector<float> areas, std::vector<Rgb> reflectances, float open = 0.0F) : open_share(open) {
    patches.area = std::move(areas);
    patches.reflectance = std::move(reflectances);
    patches.glow.resize(patches.area.size(), Rgb(0.0F));
  }
  double area() const { return std::accumulate(patches.area.begin(), patches.area.end(), 0.0); }

  std::uint32_t patch_count() const override { return patches.patch_count(); }
  FormFactorRow row(std::uint32_t) const override {
    FormFactorRow row;
    for (std::uint32_t j = 0; j < patch_count(); ++j) {
      row.patch.push_back(j);
      row.factor.push_back((1.0F - open_share) * patches.area[j] / static_cast<float>(area()));
    }
    row.to_sky = open_share;
    return row;
  }
};

/// Six patches of all sizes and greys, in full colour.
Sphere colourful_sphere(float open = 0.0F) {
  return {{1.0F, 2.0F, 0.5F, 3.0F, 0.1F, 1.4F},
          {Rgb(0.5F), {0.9F, 0.2F, 0.1F}, Rgb(0.0F), {0.3F, 0.8F, 0.4F}, Rgb(0.98F), {0.6F, 0.6F, 0.7F}},
          open};
}

std::vector<Rgb> some_direct_light() { return {{5, 4, 3}, {0, 0, 0}, {1, 1, 1}, {0, 2, 0}, {9, 9, 9}, {0, 0, 0.5F}}; }

using Solve = Solution (*)(const SolveProblem&, RowCache&, const Progress&);

Solution run(Solve solve, const RowSource& source, const SolveProblem& problem, std::size_t cache_bytes = kRoomy) {
  RowCache rows(source, cache_bytes);
  return solve(problem, rows, {});
}

struct Solvers : testing::TestWithParam<Solve> {
  Solution solve(const RowSource& source, const SolveProblem& problem, std::size_t cache_bytes = kRoomy) const {
    return run(GetParam(), source, problem, cache_bytes);
  }
};

void expect_near(const std::vector<Rgb>& actual, const std::vector<Rgb>& expected, float relative) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    for (int band = 0; band < 3; ++band) {
      EXPECT_NEAR(actual[i][band], expected[i][band], relative * expected[i][band] + 1e-12F) << i << ", band " << band;
    }
  }
}

/// Area-weighted root mean square of the difference, relative to the mean of `b`.
double relative_rms(const Patches& patches, const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
  double square = 0.0, mean = 0.0, area = 0.0;
  for (std::uint32_t i = 0; i < patches.patch_count(); ++i) {
    const double difference = double{luminance_of(a[i])} - double{luminance_of(b[i])};
    square += double{patches.area[i]} * difference * difference;
    mean += double{patches.area[i]} * double{luminance_of(b[i])};
    area += double{patches.area[i]};
  }
  return std::sqrt(square / area) / (mean / area);
}

TEST_P(Solvers, LeaveExitanceAloneWhereNothingReflects) {
  Sphere black({1, 2, 3}, {Rgb(0.0F), Rgb(0.0F), Rgb(0.0F)});
  black.patches.glow = {{1, 2, 3}, {0, 0, 0}, {0.5F, 0, 0}};
  const std::vector<Rgb> direct(3, Rgb(7.0F));
  const Solution solution = solve(black, {black.patches, direct});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(solution.radiosity[i], exitance_of_luminance(black.patches.glow[i]));
}

TEST_P(Solvers, AreLinear) {
  Sphere room = colourful_sphere();
  std::vector<Rgb> direct = some_direct_light();
  room.patches.glow[3] = {1, 2, 3};
  const Solution dim = solve(room, {room.patches, direct});
  for (Rgb& light : direct) light *= 1000.0F;
  for (Rgb& glow : room.patches.glow) glow *= 1000.0F;
  const Solution bright = solve(room, {room.patches, direct});

  std::vector<Rgb> expected = dim.radiosity;
  for (Rgb& radiosity : expected) radiosity *= 1000.0F;
  expect_near(bright.radiosity, expected, 1e-4F);
  EXPECT_EQ(bright.steps, dim.steps);
}

// Inside a sphere all patches receive the same H from each other: H = sum(A first) / (A - sum(A rho)).
TEST_P(Solvers, FindTheLightInsideASphere) {
  Sphere room = colourful_sphere();
  room.patches.glow[2] = {0.1F, 0.2F, 0.3F};
  const std::vector<Rgb> direct = some_direct_light();
  const SolveProblem problem{room.patches, direct, 1e-5F};
  const std::vector<glm::dvec3> first = first_radiosity(problem);
  glm::dvec3 sent(0.0), kept(room.area());
  for (std::uint32_t i = 0; i < room.patch_count(); ++i) {
    sent += double{room.patches.area[i]} * first[i];
    kept -= double{room.patches.area[i]} * glm::dvec3(room.patches.reflectance[i]);
  }
  std::vector<Rgb> expected;
  for (std::uint32_t i = 0; i < room.patch_count(); ++i) {
    expected.emplace_back(first[i] + glm::dvec3(room.patches.reflectance[i]) * sent / kept);
  }
  const Solution solution = solve(room, problem);
  expect_near(solution.radiosity, expected, 1e-4F);
  EXPECT_TRUE(solution.converged);
}

TEST_P(Solvers, FindEOver1MinusRhoInAWhiteFurnace) {
  for (const float rho : {0.5F, 0.9F, 0.98F}) {
    Sphere furnace({1, 2, 3, 0.01F}, std::vector<Rgb>(4, Rgb(rho)));
    furnace.patches.glow.assign(4, Rgb(1.0F));
    const std::vector<Rgb> dark(4, Rgb(0.0F));
    const Solution solution = solve(furnace, {furnace.patches, dark, 1e-4F});
    for (const Rgb& radiosity : solution.radiosity) {
      EXPECT_NEAR(radiosity.x * (1.0F - rho) / exitance_of_luminance(Rgb(1.0F)).x, 1.0F, 1e-3F) << rho;
    }
  }
}

TEST_P(Solvers, TellWhatArrivesAtBlackPatchesToo) {
  const Sphere room({1.0F, 1.0F}, {Rgb(0.5F), Rgb(0.0F)});
  const std::vector<Rgb> direct = {Rgb(4.0F), Rgb(0.0F)};
  const Solution solution = solve(room, {room.patches, direct, 1e-5F});
  // H = (2 + 0.5 H) / 2 everywhere.
  for (const Rgb& irradiance : solution.irradiance) EXPECT_NEAR(irradiance.x, 4.0F / 3.0F, 1e-4F);
  EXPECT_EQ(solution.radiosity[1], Rgb(0.0F));
}

TEST_P(Solvers, KeepBandsApart) {
  const Sphere room = colourful_sphere();
  std::vector<Rgb> direct(6, Rgb(0.0F));
  direct[0] = {1, 0, 0};
  for (const Rgb& radiosity : solve(room, {room.patches, direct}).radiosity) {
    EXPECT_GE(radiosity.x, 0.0F);
    EXPECT_EQ(radiosity.y, 0.0F);
    EXPECT_EQ(radiosity.z, 0.0F);
  }
}

TEST_P(Solvers, StopAtTheResidualAskedFor) {
  const Sphere room = colourful_sphere();
  const std::vector<Rgb> direct = some_direct_light();
  std::uint32_t fewest_steps = 0;
  for (const float residual : {0.1F, 0.01F, 0.001F, 1e-5F}) {
    const Solution solution = solve(room, {room.patches, direct, residual});
    EXPECT_LE(solution.residual, residual);
    EXPECT_TRUE(solution.converged);
    EXPECT_GE(solution.steps, fewest_steps);
    fewest_steps = solution.steps;
  }
  EXPECT_GT(fewest_steps, solve(room, {room.patches, direct, 0.1F}).steps);
}

TEST_P(Solvers, AreNotFurtherFromTheTruthThanTheResidual) {
  const Sphere room = colourful_sphere();
  const std::vector<Rgb> direct = some_direct_light();
  const SolveProblem exact{room.patches, direct, 1e-7F};
  const double emitted = flux_of(room.patches, first_radiosity(exact));
  const Solution truth = solve(room, exact);
  for (const float residual : {0.1F, 0.01F, 0.001F}) {
    const Solution solution = solve(room, {room.patches, direct, residual});
    double missing = 0.0;
    for (std::uint32_t i = 0; i < room.patch_count(); ++i) {
      missing += double{room.patches.area[i] * luminance_of(truth.radiosity[i] - solution.radiosity[i])};
    }
    // What is unshot would still be reflected 1 / (1 - rho) times.
    EXPECT_LE(std::abs(missing) / emitted, double{residual} / (1.0 - mean_reflectance(room.patches).x)) << residual;
  }
}

TEST_P(Solvers, DoNothingInTheDark) {
  const Sphere room = colourful_sphere();
  const std::vector<Rgb> dark(6, Rgb(0.0F));
  const Solution solution = solve(room, {room.patches, dark});
  EXPECT_EQ(solution.steps, 0U);
  EXPECT_EQ(solution.residual, 0.0F);
  EXPECT_TRUE(solution.converged);
  for (const Rgb& radiosity : solution.radiosity) EXPECT_EQ(radiosity, Rgb(0.0F));
}

TEST_P(Solvers, AcceptASceneWithoutPatches) {
  const Sphere nothing({}, {});
  EXPECT_TRUE(solve(nothing, {nothing.patches, {}}).radiosity.empty());
}

TEST_P(Solvers, DoNotDependOnTheMemoryForRows) {
  const PreparedScene s(test::cornell_box(), 120, 8);
  const std::vector<Rgb> direct = direct_on_patches(s.direct, s.patches, {});
  const SolveProblem problem{s.patches, direct, 0.01F};
  const Solution roomy = solve(*s.rows, problem), tight = solve(*s.rows, problem, 10'000);
  EXPECT_EQ(roomy.radiosity, tight.radiosity);
  EXPECT_EQ(roomy.steps, tight.steps);
}

TEST_P(Solvers, StopWhenCancelled) {
  const Sphere room = colourful_sphere();
  const std::vector<Rgb> direct = some_direct_light();
  RowCache rows(room, kRoomy);
  const Progress cancelled{.report = {}, .cancelled = [] { return true; }};
  EXPECT_THROW(GetParam()({room.patches, direct}, rows, cancelled), Cancelled);
}

TEST_P(Solvers, EndWithWhatTheyHaveWhenTimeIsUp) {
  const Sphere room = colourful_sphere();
  const std::vector<Rgb> direct = some_direct_light();
  RowCache rows(room, kRoomy);
  const Progress hurried{.report = {}, .cancelled = {}, .seconds_left = [] { return 1.0; }};
  const Solution in_time = GetParam()({room.patches, direct}, rows, hurried);
  EXPECT_FALSE(in_time.out_of_time);
  const SolveProblem reserved{room.patches, direct, 0.001F, 2.0};
  const Solution cut_short = GetParam()(reserved, rows, hurried);
  EXPECT_TRUE(cut_short.out_of_time);
  EXPECT_FALSE(cut_short.converged);
  ASSERT_EQ(cut_short.radiosity.size(), in_time.radiosity.size());
  // Nothing but what the direct light makes is certain by then, and an estimate of the rest is allowed.
  const std::vector<glm::dvec3> first = first_radiosity(reserved);
  for (std::size_t i = 0; i < first.size(); ++i)
    EXPECT_GE(cut_short.radiosity[i].x, 0.999F * static_cast<float>(first[i].x));
}

INSTANTIATE_TEST_SUITE_P(Both, Solvers, testing::Values(&solve_progressive, &solve_gathering),
                         [](const auto& solver) { return solver.index == 0 ? "Progressive" : "Gathering"; });

TEST(SolveProgressive, ShootsThePatchWithTheMostFluxFirst) {
  // Nine tenths of the flux wait at the large dim patch; the small bright one has the higher radiosity. Shooting the
  // right one leaves 0.1 + 0.9 * 0.05 unshot.
  const Sphere room({9.0F, 0.1F}, {Rgb(0.05F), Rgb(0.05F)});
  const std::vector<Rgb> direct = {Rgb(1.0F), Rgb(10.0F)};
  const Solution solution = run(&solve_progressive, room, {room.patches, direct, 0.2F});
  EXPECT_EQ(solution.steps, 1U);
  EXPECT_NEAR(solution.residual, 0.1F + 0.9F * 0.05F, 1e-5F);
}

TEST(SolveProgressive, SpreadsWhatIsUnshotAsAmbientLight) {
  // So little is asked for that nothing is shot: all that is known is the estimate, and in a sphere it is exact.
  const Sphere room({1.0F, 3.0F}, {Rgb(0.5F), Rgb(0.5F)});
  const std::vector<Rgb> direct = {Rgb(4.0F), Rgb(0.0F)};
  const Solution solution = run(&solve_progressive, room, {room.patches, direct, 1.0F});
  EXPECT_EQ(solution.steps, 0U);
  expect_near(solution.radiosity, {Rgb(2.0F + 0.5F * 1.0F), Rgb(0.5F * 1.0F)}, 1e-6F);
}

TEST(AmbientEstimate, IsTheMeanUnshotReflectedOnAndOn) {
  const Sphere room({1.0F, 3.0F}, {{0.0F, 0.5F, 0.9F}, {0.0F, 0.5F, 0.9F}});
  const std::vector<glm::dvec3> unshot = {glm::dvec3(8.0), glm::dvec3(0.0)};
  const Rgb ambient = ambient_estimate(room.patches, unshot);
  expect_near({ambient}, {Rgb(2.0F, 4.0F, 20.0F)}, 1e-5F);
  EXPECT_EQ(ambient_estimate(Patches{}, {}), Rgb(0.0F));
}

TEST(FirstRadiosity, IsTheGlowAndTheReflectedDirectLight) {
  Sphere room({1.0F}, {{0.5F, 0.25F, 0.0F}});
  room.patches.glow = {{1, 0, 1}};
  const std::vector<Rgb> direct = {Rgb(8.0F)};
  const std::vector<glm::dvec3> first = first_radiosity({room.patches, direct});
  expect_near({Rgb(first[0])}, {{kPi + 4.0F, 2.0F, kPi}}, 1e-6F);
}

// Shooting conserves energy: what is first sent is in the end absorbed, gone, or still unshot.
TEST(SolveProgressive, LosesNoEnergy) {
  for (const bool measured : {false, true}) {
    const Sphere open_sphere = colourful_sphere(0.3F);
    const PreparedScene cornell(test::cornell_box(), 150, 16);
    const Patches& patches = measured ? cornell.patches : open_sphere.patches;
    const RowSource& source = measured ? *cornell.rows : static_cast<const RowSource&>(open_sphere);
    const std::vector<Rgb> direct = measured ? direct_on_patches(cornell.direct, patches, {}) : some_direct_light();
    const SolveProblem problem{patches, direct, 1e-4F};
    RowCache rows(source, kRoomy);
    const Solution solution = solve_progressive(problem, rows, {});

    std::vector<double> received(patches.patch_count(), 0.0);
    double escaped = 0.0, absorbed = 0.0;
    for (std::uint32_t i = 0; i < patches.patch_count(); ++i) {
      const double flux = double{patches.area[i] * luminance_of(solution.radiosity[i])};
      const FormFactorRow& row = rows.row(i);
      for (std::size_t k = 0; k < row.patch.size(); ++k) received[row.patch[k]] += flux * double{row.factor[k]};
      escaped += flux * double{row.to_sky + row.to_backs};
    }
    for (std::uint32_t i = 0; i < patches.patch_count(); ++i) {
      const Rgb first = patches.reflectance[i] * direct[i];
      absorbed += received[i] - double{patches.area[i] * luminance_of(solution.radiosity[i] - first)};
    }
    const double emitted = flux_of(patches, first_radiosity(problem));
    EXPECT_NEAR((absorbed + escaped) / emitted, 1.0, 1e-3);
    EXPECT_GT(escaped / emitted, 0.05);
  }
}

TEST(BothSolvers, AgreeOnMeasuredRows) {
  for (const Scene& scene : {test::cornell_box(), test::occluder()}) {
    const PreparedScene s(scene, 400, 32);
    const std::vector<Rgb> direct = direct_on_patches(s.direct, s.patches, {});
    const SolveProblem problem{s.patches, direct, 1e-4F};
    const Solution shot = run(&solve_progressive, *s.rows, problem);
    const Solution gathered = run(&solve_gathering, *s.rows, problem);
    EXPECT_LT(relative_rms(s.patches, shot.radiosity, gathered.radiosity), 0.005);
  }
}

TEST(BothSolvers, FindEOver1MinusRhoOnMeasuredRows) {
  for (const float rho : {0.5F, 0.9F}) {
    const PreparedScene s(test::white_furnace(rho, 1.0F), 300, 16);
    const std::vector<Rgb> direct(s.patches.patch_count(), Rgb(kPi));
    const SolveProblem problem{s.patches, direct, 1e-4F};
    // Lamps are left out of the radiosity: E / (1 - rho) less E itself.
    const std::vector<Rgb> expected(s.patches.patch_count(), Rgb(kPi * (1.0F / (1.0F - rho) - 1.0F)));
    expect_near(run(&solve_gathering, *s.rows, problem).radiosity, expected, 0.002F);
    EXPECT_LT(relative_rms(s.patches, run(&solve_progressive, *s.rows, problem).radiosity, expected), 0.005);
  }
}

}  // namespace
}  // namespace radiosity
