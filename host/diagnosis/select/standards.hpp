#pragma once

#include <cstddef>

/// Thresholds that a finding must pass. Each line says what its threshold trades. The commit that
/// brought it, named in brackets, has the scores of tools/score-diagnosis by which it was set.
namespace flexcomp::diagnosis {

/// Deviations by which what was held out must confirm a finding: false alarms against weak effects
/// (024da06).
constexpr double kConfirmed = 2;
/// Confirmation that outweighs the estimate of the noise: of a mismatch as fast as noise, that
/// estimate is too large (1175996).
constexpr double kOverwhelming = 20;
/// Least effect, over the noise of the component that shows it most: nobody could use a weaker one
/// (024da06).
constexpr double kLeastStrength = 1.0 / 3;
/// Least effect, over that of the whole fit: a weaker one is within the exactness of a motion's
/// simulation (6d8c9c3).
constexpr double kExactness = 0.02;
/// Least power beyond the noise, over the power that a finding takes away: a filter explains the
/// encoder noise in a prediction, which is no mismatch (fe36598: 1 of 44 clean recordings).
constexpr double kLeastBeyondNoise = 0.75;
/// Least share of the power beyond the noise that a finding takes away: many small steps lead
/// astray (024da06).
constexpr double kLeastShare = 0.1;
/// Least share of a mismatch's power that all findings explain together: physics outside the
/// catalogue against effects whose laws are only nearly ours (024da06).
constexpr double kLeastExplained = 0.9;
/// Least share of the power explained where no more than `kFarFromNoise` is left: the laws of other
/// engines are not quite ours, so that no more can be had (4675fca).
constexpr double kExplainedNearNoise = 0.8;
/// Least share that the numbers of families explain together, each of which stands by its own
/// evidence: a real machine always has errors that nobody models.
constexpr double kLeastByFamilies = 0.6;
/// Numbers of a family that must stand together: fewer causes are found one by one, and physics
/// outside the catalogue is imitated by one or two (tests/diagnosis/test_retune.cpp).
constexpr std::size_t kLeastMembers = 3;
/// Times the noise: what leaves more has not been understood (0f27f02).
constexpr double kFarFromNoise = 2;
/// Times the noise, or model error, that was taken for what nothing explains: where less is left,
/// all is weighed anew by what is left. Time against an estimate that is told to a tenth.
constexpr double kMuchLess = 0.8;
/// Findings at most: a recording of a real robot needs a dozen (842a13d).
constexpr std::size_t kMostFindings = 20;
/// Findings at one place at most: more would be a sum that fits anything, and takes minutes
/// (a51463b).
constexpr int kMostInGroup = 5;
/// Findings at one place at most in a load test: its poses lie all over, which tells many small
/// errors of geometry apart (31c28d3).
constexpr int kMostInLoadTest = 16;
/// Hypotheses fitted beside a fit before the best is taken: time against a screening that is only
/// linear (024da06).
constexpr std::size_t kShortlist = 5;
/// Times as many are looked at where some cannot be (022993e).
constexpr std::size_t kLongShortlist = 2;
/// From so many findings on fits are slow and little is ambiguous: a shorter list does (842a13d).
constexpr std::size_t kMany = 4;
constexpr std::size_t kShortShortlist = 2;
/// Share of the squares that so many leave which a machine's numbers together would leave,
/// predicted: below it no finding is sought more, but all are fitted at once. Time against effects
/// that are in no family: those are among the first to be found, or not above the rest.
constexpr double kLeftByFamilies = 0.7;
/// Steps of fits that are compared, of fits that are kept, and of the last one: time against
/// exactness (024da06).
constexpr int kQuickSteps = 4;
constexpr int kSteps = 12;
constexpr int kLastSteps = 60;
/// Times the noise: below it nothing is left that two effects could share (67f0a6b).
constexpr double kSettled = 1.1;
/// Pairs that are fitted: a third effect may look better than either of two (67f0a6b).
constexpr std::size_t kPairs = 3;
/// Cosine between what two effects change: below it neither can stand in for the other, like the
/// frictions of two joints (842a13d).
constexpr double kMeeting = 0.03;
/// BIC: two findings that differ by less do the same in numbers, and the smaller change is meant
/// (3c9165b).
constexpr double kIdentical = 0.1;
/// Share of a finding's gain in BIC: no simplified body is told from another by less (0f27f02).
constexpr double kNegligible = 1e-3;
/// BIC: twice what proves a finding takes it back.
constexpr double kFarMoreEvidence = 20;
/// Share of a finding's gain in BIC: no law that nobody listed, and no effect that few machines
/// have, is told from a usual effect by less. A real machine has errors besides, far above the
/// noise, which change comparisons by as much (effects planted into real recordings,
/// tests/campaigns/machines).
constexpr double kUnusual = 0.02;
/// Share of a finding's gain in BIC: within it one number takes the place of a body's many. A real
/// machine has errors besides, which change such comparisons by as much.
constexpr double kFarPlainer = 0.01;
/// Times the squares: a form of the same law that leaves no more may be the machine's (measured on
/// loops of MuJoCo's sliders, tools/concealed, seeds 771203 and 828101: Prandtl and Ishlinskii's
/// against Bouc and Wen's).
constexpr double kNearlyAsGood = 1.3;
/// BIC: "not worth more than a bare mention" (Kass and Raftery 1995).
constexpr double kIndifferent = 2;

}  // namespace flexcomp::diagnosis
