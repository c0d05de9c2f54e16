#include "tools/lab/tables/requirements.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace cgsr::lab {
namespace {

constexpr Requirement at_least(double bound) {
  return {bound, Requirement::Kind::kAtLeast};
}
constexpr Requirement at_most(double bound) {
  return {bound, Requirement::Kind::kAtMost};
}
constexpr Requirement interval_within(double bound) {
  return {bound, Requirement::Kind::kIntervalWithin};
}

constexpr std::string_view kGate =
    "the gate, fitted over drawn homes so that false claims stay rare, refuses right poses";
constexpr std::string_view kSettling =
    "in drawn homes the alignment settles at wrong poses too; the gate lets some of them pass and refuses right ones";
constexpr std::string_view kHalfPixel = "twelve of 28 sequences exceed it, skating2 and skiing by most";
constexpr std::string_view kLookAlikes =
    "most of them in three of 28 sequences where another that looks alike is in view: deer, human3 and "
    "skating2";
constexpr std::string_view kNotSeparated =
    "what comes back half as large, or from another side, is not recognised; of the rest some is not looked at, and "
    "some shows no more evidence than other things do";
constexpr std::string_view kBrownLooksOrange =
    "a brown ball in strong light looks like an orange one in weak light, and like one in shade where it may lie in it "
    "for all that is known";
constexpr std::string_view kFaces = "known faces near the threshold are called strangers";

// Units are those of the rows: cm, degrees, px, Minstr (million instructions per image), s, shares.
constexpr std::array kRequirements{
    // Chapter 3.
    NamedRequirement{"light-sweep", "ours, light 0.6 to 1", "precision", at_least(0.95)},
    NamedRequirement{"light-sweep", "ours, light 0.6 to 1", "IoU", at_least(0.85)},
    NamedRequirement{"light-sweep", "light estimate", "nearest grid light", at_least(0.7)},
    NamedRequirement{"light-sweep", "light estimate", "error per channel", at_most(0.07)},
    NamedRequirement{"real-video", "mean / ours", "precision", at_least(0.6)},
    NamedRequirement{"real-video", "mean / ours", "recall", at_least(0.6)},
    NamedRequirement{"tracking-benchmark", "one pass / ours minus CSRT", "AUC", at_least(0.06)},
    NamedRequirement{"tracking-benchmark", "one pass / ours minus CSRT", "precision", at_least(0.05)},
    NamedRequirement{"tracking-benchmark", "one pass, ours over the better of KCF and CSRT", "sequences below .75",
                     at_most(2.0)},
    NamedRequirement{"tracking-benchmark", "one pass, ours over the better of KCF and CSRT", "sequences below .5",
                     at_most(0.0), "book is lost early and found again late"},
    NamedRequirement{"tracking-benchmark", "spatial robustness / ours minus CSRT", "AUC", at_least(0.03)},
    NamedRequirement{"tracking-benchmark", "temporal robustness / ours minus CSRT", "AUC", at_least(0.03)},
    NamedRequirement{"tracking-benchmark", "first box moved by half a pixel / ours", "largest change of IoU",
                     at_most(0.05), kHalfPixel},
    NamedRequirement{"tracking-benchmark", "relit, sinusoids / ours", "lost IoU", at_most(0.03)},
    NamedRequirement{"tracking-benchmark", "relit, steps / ours", "lost IoU", at_most(0.03)},
    NamedRequirement{"tracking-benchmark", "relit, warm-cold swing / ours", "lost IoU", at_most(0.03)},
    NamedRequirement{"tracking-benchmark", "relit, dimming to a quarter / ours", "lost IoU", at_most(0.08)},
    NamedRequirement{"tracking-benchmark", "relit, moving spot / ours", "lost IoU", at_most(0.03)},
    NamedRequirement{"tracking-benchmark", "light estimate, printed", "error per channel", at_most(0.06)},
    NamedRequirement{"tracking-benchmark", "light estimate, printed", "chroma correlation", at_least(0.85)},
    NamedRequirement{"tracking-benchmark", "object absent / ours", "false claims", at_most(0.02), kLookAlikes},
    NamedRequirement{"tracking-benchmark", "object absent / ours", "found again within 15 images", at_least(0.9),
                     kNotSeparated},
    NamedRequirement{"tracking-benchmark", "confidence, all folds", "calibration error", at_most(0.05)},
    NamedRequirement{"tracking-benchmark", "cost at 640x480 / ours", "mean", at_most(10.0)},
    NamedRequirement{"tracking-benchmark", "cost at 640x480 / ours", "worst", at_most(14.0)},
    NamedRequirement{"tracking-relit", "relit, sinusoids / ours", "lost IoU", at_most(0.03)},
    NamedRequirement{"tracking-relit", "relit, steps / ours", "lost IoU", at_most(0.03)},
    NamedRequirement{"tracking-relit", "relit, warm-cold swing / ours", "lost IoU", at_most(0.03)},
    NamedRequirement{"tracking-relit", "relit, dimming to a quarter / ours", "lost IoU", at_most(0.08)},
    NamedRequirement{"tracking-relit", "relit, moving spot / ours", "lost IoU", at_most(0.03)},
    NamedRequirement{"tracking-relit", "light estimate, printed", "error per channel", at_most(0.06)},
    NamedRequirement{"tracking-relit", "light estimate, printed", "chroma correlation", at_least(0.85)},
    NamedRequirement{"tracking-relit", "relit, sinusoids / ours minus CSRT", "IoU", at_least(0.0)},
    NamedRequirement{"tracking-relit", "relit, steps / ours minus CSRT", "IoU", at_least(0.0)},
    NamedRequirement{"tracking-relit", "relit, warm-cold swing / ours minus CSRT", "IoU", at_least(0.0)},
    NamedRequirement{"tracking-relit", "relit, dimming to a quarter / ours minus CSRT", "IoU", at_least(0.0)},
    NamedRequirement{"tracking-relit", "relit, moving spot / ours minus CSRT", "IoU", at_least(0.0)},
    NamedRequirement{"tracking-cost", "cost at 640x480 / ours", "mean", at_most(10.0)},
    NamedRequirement{"tracking-cost", "cost at 640x480 / ours", "worst", at_most(14.0)},
    NamedRequirement{"search-cost", "all", "labels and search", at_most(5.0)},
    NamedRequirement{"search-cost", "all", "labels and search, worst", at_most(7.0)},
    NamedRequirement{"figure-3.3", "ours", "seconds that hold", at_least(1.0)},
    NamedRequirement{"closed-loop", "in view from the first sight on", "worst", at_least(0.95)},
    NamedRequirement{"closed-loop", "nearest by its own motion, of the set distance", "worst", at_least(0.8)},
    NamedRequirement{"closed-loop", "commanded zero after the object came nearer", "worst", at_most(0.5)},
    NamedRequirement{"closed-loop", "commanded zero after a loss", "worst", at_most(0.5)},
    NamedRequirement{"closed-loop", "standing after a loss", "worst", at_most(0.5)},
    // Chapter 4.
    NamedRequirement{"homes-4.1", "ours", "corrected", at_least(0.95), kSettling},
    NamedRequirement{"homes-4.1", "ours", "position error", at_most(2.0)},
    NamedRequirement{"homes-4.1", "ours", "direction error", at_most(0.3), kSettling},
    NamedRequirement{"homes-4.1", "ours", "within 5 cm and 1 deg", at_least(0.95), kSettling},
    NamedRequirement{"homes-4.1", "ours", "false claims", at_most(0.005), kSettling},
    NamedRequirement{"homes-4.1", "ours, perfect copy", "position error", at_most(1.0)},
    NamedRequirement{"homes-4.1", "ours, perfect copy", "direction error", at_most(0.1)},
    NamedRequirement{"gate-reliability", "as configured: at most 0.01 stated", "wrong", at_most(0.01)},
    NamedRequirement{"start-anywhere", "ours", "right within 20 s", at_least(0.8),
                     "the turn takes ten seconds, and the first look at a candidate searches for three"},
    NamedRequirement{"start-anywhere", "ours", "wrong and claimed", at_most(0.01)},
    NamedRequirement{"table-4.1", "ours", "corrected", at_least(0.95), kGate},
    NamedRequirement{"table-4.1", "ours", "position error", at_most(2.5)},
    NamedRequirement{"table-4.1", "ours", "direction error", at_most(0.5)},
    NamedRequirement{"table-4.1", "ours, perfect copy", "corrected", at_least(0.97)},
    NamedRequirement{"table-4.1", "ours, perfect copy", "position error", at_most(1.0)},
    NamedRequirement{"table-4.1", "ours, perfect copy", "direction error", at_most(0.2)},
    NamedRequirement{"section-4.3.3", "ours, what they change", "position error", interval_within(0.5)},
    NamedRequirement{"section-4.3.3", "ours, what they change", "direction error", interval_within(0.2)},
    NamedRequirement{"false-corrections", "all", "false corrections", at_most(0.005)},
    NamedRequirement{"false-corrections", "right map, nothing in front, prior 1 times as wide", "corrected",
                     at_least(0.95), kGate},
    NamedRequirement{"false-corrections", "right map, nothing in front, prior 3 times as wide", "corrected",
                     at_least(0.6)},
    NamedRequirement{"home-round", "camera's position, worst image of a run", "largest", at_most(6.0)},
    NamedRequirement{"home-round", "camera's direction, worst image of a run", "largest", at_most(1.5)},
    NamedRequirement{"homes-round", "a minute", "homes: 0.95 of images accurate", at_least(1.0)},
    NamedRequirement{"homes-round", "a minute", "homes: lost for 3 s at most", at_least(1.0)},
    NamedRequirement{"homes-round", "a minute", "homes: wrong for 1 s at most", at_least(1.0)},
    NamedRequirement{"homes-round", "three minutes", "homes: 0.95 of images accurate", at_least(1.0)},
    NamedRequirement{"homes-round", "three minutes", "homes: lost for 3 s at most", at_least(1.0)},
    NamedRequirement{"homes-round", "three minutes", "homes: wrong for 1 s at most", at_least(1.0)},
    NamedRequirement{"table-4.2", "50 edges, others behind, ours", "mean", at_most(10.0)},
    NamedRequirement{"table-4.2", "50 edges, others behind, ours", "worst", at_most(13.0)},
    NamedRequirement{"table-4.2", "50 edges, half in view, ours", "mean", at_most(10.0)},
    NamedRequirement{"table-4.2", "50 edges, half in view, ours", "worst", at_most(13.0)},
    NamedRequirement{"table-4.2", "150 edges, others behind, ours", "mean", at_most(10.0)},
    NamedRequirement{"table-4.2", "150 edges, others behind, ours", "worst", at_most(13.0)},
    NamedRequirement{"table-4.2", "150 edges, half in view, ours", "mean", at_most(10.0)},
    NamedRequirement{"table-4.2", "150 edges, half in view, ours", "worst", at_most(13.0)},
    NamedRequirement{"table-4.2", "450 edges, others behind, ours", "mean", at_most(10.0)},
    NamedRequirement{"table-4.2", "450 edges, others behind, ours", "worst", at_most(13.0)},
    NamedRequirement{"table-4.2", "450 edges, half in view, ours", "mean", at_most(10.0)},
    NamedRequirement{"table-4.2", "450 edges, half in view, ours", "worst", at_most(13.0)},
    NamedRequirement{"table-4.2", "1250 edges, others behind, ours", "mean", at_most(10.0)},
    NamedRequirement{"table-4.2", "1250 edges, others behind, ours", "worst", at_most(13.0)},
    NamedRequirement{"table-4.2", "1250 edges, half in view, ours", "mean", at_most(10.0)},
    NamedRequirement{"table-4.2", "1250 edges, half in view, ours", "worst", at_most(13.0)},
    NamedRequirement{"table-4.2", "3725 edges, others behind, ours", "mean", at_most(10.0)},
    NamedRequirement{"table-4.2", "3725 edges, others behind, ours", "worst", at_most(13.0)},
    NamedRequirement{"table-4.2", "3725 edges, half in view, ours", "mean", at_most(10.0)},
    NamedRequirement{"table-4.2", "3725 edges, half in view, ours", "worst", at_most(13.0)},
    NamedRequirement{"table-4.2", "100000 edges, others behind, ours", "mean", at_most(16.0)},
    NamedRequirement{"table-4.2", "1000000 edges, others behind, ours", "mean", at_most(20.0)},
    NamedRequirement{
        "map-refine", "each part off", "corners after", at_most(1.5),
        "no image shows where the home is as a whole (a column takes that out); and parts among lines that repeat "
        "(racks, sills, skirtings, walls of which one edge is seen) settle on a wrong line"},
    NamedRequirement{
        "map-refine", "each part off", "moved chair proposed", at_least(1.0),
        "a moved piece is looked for on a grid with nothing before it and counts where six images or more show "
        "some of it: one that others hide most of is missed, and of a round stool no edge is straight and long "
        "enough"},
    NamedRequirement{"real-localization", "Castle-simu, from 2 % and 2 degrees, ours", "below 1 % and 1 degree",
                     at_least(0.95)},
    NamedRequirement{"real-localization", "Castle-simu, from 5 % and 5 degrees, ours", "below 1 % and 1 degree",
                     at_least(0.8)},
    NamedRequirement{"real-localization", "Castle-simu, from 2 % and 2 degrees, ours", "median position",
                     at_most(0.25)},
    NamedRequirement{"real-localization", "Castle-simu, from 2 % and 2 degrees, ours", "median direction",
                     at_most(0.25)},
    NamedRequirement{"real-localization", "Castle-simu, from 5 % and 5 degrees, ours", "median position",
                     at_most(0.25)},
    NamedRequirement{"real-localization", "Castle-simu, from 5 % and 5 degrees, ours", "median direction",
                     at_most(0.25)},
    NamedRequirement{"real-localization", "castel, ours", "corrected", at_least(1.0)},
    NamedRequirement{"real-localization", "castel, ours less the best of ViSP", "within 3 px", at_least(0.0)},
    NamedRequirement{"real-localization", "desk, ours, beside the marker board", "within 15 px and 1.5 cm",
                     at_least(0.8), "the board's poses are good to about 1 cm or 10 px themselves"},
    NamedRequirement{"real-localization", "desk, ours, beside the marker board", "claimed over 30 px off",
                     at_most(0.0)},
    NamedRequirement{"real-localization", "cube, ours", "followed (Canny)", at_least(1.0)},
    NamedRequirement{"real-localization", "cube, ours", "median distance", at_most(2.0)},
    NamedRequirement{"real-localization", "cube, ours", "within 3 px", at_least(0.8)},
    // Chapter 5.
    NamedRequirement{"table-5.1", "both, 20 deg", "mean error", at_most(4.0)},
    NamedRequirement{"table-5.1", "both, 20 deg", "answered", at_least(0.9)},
    NamedRequirement{"table-5.1", "both, 20 deg", "error, height triangulated", at_most(15.0)},
    NamedRequirement{"table-5.1", "both, 30 deg", "mean error", at_most(4.0)},
    NamedRequirement{"table-5.1", "both, 30 deg", "answered", at_least(0.9)},
    NamedRequirement{"table-5.1", "both, 30 deg", "error, height triangulated", at_most(15.0)},
    NamedRequirement{"table-5.1", "both, 40 deg", "mean error", at_most(5.0)},
    NamedRequirement{"table-5.1", "both, 40 deg", "answered", at_least(0.9)},
    NamedRequirement{"table-5.1", "both, 40 deg", "error, height triangulated", at_most(15.0)},
    NamedRequirement{"table-5.1", "both, 50 deg", "mean error", at_most(5.5)},
    NamedRequirement{"table-5.1", "both, 50 deg", "answered", at_least(0.9)},
    NamedRequirement{"table-5.1", "both, 60 deg", "mean error", at_most(7.0)},
    NamedRequirement{"table-5.1", "both, 60 deg", "answered", at_least(0.9)},
    NamedRequirement{"table-5.1", "one, 20 deg", "mean error", at_most(6.0)},
    NamedRequirement{"table-5.1", "one, 20 deg", "answered", at_least(0.9)},
    NamedRequirement{"table-5.1", "one, 30 deg", "mean error", at_most(6.0)},
    NamedRequirement{"table-5.1", "one, 30 deg", "answered", at_least(0.9)},
    NamedRequirement{"table-5.1", "one, 40 deg", "mean error", at_most(6.5)},
    NamedRequirement{"table-5.1", "one, 40 deg", "answered", at_least(0.9)},
    NamedRequirement{"table-5.1", "one, 50 deg", "mean error", at_most(7.0)},
    NamedRequirement{"table-5.1", "one, 50 deg", "answered", at_least(0.9)},
    NamedRequirement{"table-5.1", "one, 60 deg", "mean error", at_most(9.0)},
    NamedRequirement{"table-5.1", "one, 60 deg", "answered", at_least(0.9)},
    NamedRequirement{"table-5.1", "cost, probes", "mean", at_most(2.0)},
    NamedRequirement{"lamps-5.1", "radius not told", "answered", at_least(0.95)},
    NamedRequirement{"lamps-5.1", "radius not told", "mean error", at_most(6.0)},
    NamedRequirement{"lamps-5.1", "radius not told", "within its 99 % bound", at_least(0.97)},
    NamedRequirement{"homes-5.1", "one image", "answered", at_least(0.95)},
    NamedRequirement{"homes-5.1", "one image", "mean error", at_most(6.0)},
    NamedRequirement{"homes-5.1", "one image", "within its 99 % bound", at_least(0.97)},
    NamedRequirement{"homes-5.1", "drive, pose errors that last", "at most 4 cm off at its end", at_least(0.9)},
    NamedRequirement{"homes-5.1", "drive, pose errors that last", "within its 99 % bound", at_least(0.97)},
    NamedRequirement{"lamp-cases", "one lamp", "answered", at_least(0.95)},
    NamedRequirement{"lamp-cases", "one lamp", "within its 99 % bound", at_least(0.97)},
    NamedRequirement{"lamp-cases", "one lamp", "sigma over RMS", at_most(1.5)},
    NamedRequirement{"lamp-cases", "two lamps", "within its 99 % bound", at_least(0.97)},
    NamedRequirement{"lamp-cases", "lamp behind", "answered", at_least(0.95)},
    NamedRequirement{"lamp-cases", "lamp behind", "within its 99 % bound", at_least(0.97)},
    NamedRequirement{"lamp-cases", "lamp behind", "sigma over RMS", at_most(1.5)},
    NamedRequirement{"lamp-cases", "flicker", "answered", at_least(0.95)},
    NamedRequirement{"lamp-cases", "flicker", "within its 99 % bound", at_least(0.97)},
    NamedRequirement{"lamp-cases", "flicker", "sigma over RMS", at_most(1.5)},
    NamedRequirement{"lamp-cases", "a lamp that moves", "answered", at_least(0.95)},
    NamedRequirement{"lamp-cases", "a lamp that moves", "within its 99 % bound", at_least(0.97)},
    NamedRequirement{"lamp-cases", "a lamp that moves", "sigma over RMS", at_most(1.5)},
    NamedRequirement{"lamp-cases", "a hand's shadow", "answered", at_least(0.95)},
    NamedRequirement{"lamp-cases", "a hand's shadow", "within its 99 % bound", at_least(0.97)},
    NamedRequirement{"lamp-cases", "a hand's shadow", "sigma over RMS", at_most(1.5)},
    NamedRequirement{"lamp-cases", "no lamp", "answered, wrongly", at_most(0.0)},
    NamedRequirement{"lamp-drives", "drives", "median error", at_most(2.5)},
    NamedRequirement{"lamp-drives", "drives", "95 % within", at_most(6.0)},
    NamedRequirement{"lamp-drives", "drives, pose errors that last", "within its 99 % bound", at_least(0.97)},
    NamedRequirement{"lamp-drives", "four standpoints, height not known", "mean error", at_most(5.0)},
    NamedRequirement{"section-5.4.2", "home, all known", "surface IoU", at_least(0.95)},
    NamedRequirement{"section-5.4.2", "occlusion, all known", "surface IoU", at_least(0.95)},
    NamedRequirement{"section-5.4.2", "people, all known", "surface IoU", at_least(0.95)},
    NamedRequirement{"section-5.4.2", "all worlds pooled, estimated", "ball's shade covered", at_least(0.98)},
    NamedRequirement{"section-5.4.2", "all worlds pooled, estimated", "area factor", at_most(1.4)},
    // Of the worlds, those where the truth marks a twentieth of the image or more.
    NamedRequirement{
        "section-5.4.2", "home, estimated", "area factor", at_most(1.4),
        "the home's shadows are thin, of legs and shelves, and a cell around them weighs more than they do"},
    NamedRequirement{"section-5.4.2", "occlusion, estimated", "area factor", at_most(1.4)},
    NamedRequirement{"section-5.4.2", "home, cost, new_view", "worst", at_most(7.0)},
    NamedRequirement{"section-5.4.2", "home, cost, nothing_moved", "worst", at_most(1.0)},
    NamedRequirement{"shaded-ball", "with the mask", "overlap", at_least(0.85)},
    NamedRequirement{"shaded-ball", "with the mask", "brown tracked", at_most(0.0)},
    NamedRequirement{"homes-5.4.3", "with the mask", "overlap", at_least(0.85)},
    NamedRequirement{"homes-5.4.3", "with the mask", "false", at_most(0.01), kBrownLooksOrange},
    NamedRequirement{"homes-5.4.3", "with the mask: on the floor, in shadow", "found", at_least(0.8)},
    NamedRequirement{"homes-5.4.3", "with the mask: brown ball", "taken for the orange one", at_most(0.01),
                     kBrownLooksOrange},
    NamedRequirement{"homes-5.4.3", "with the mask minus without", "overlap, off the floor", at_least(0.0)},
    NamedRequirement{"homes-5.4.3", "with the mask minus without", "overlap, in shadow", at_least(0.0)},
    NamedRequirement{"homes-5.4.3", "with the mask minus without", "overlap, lit", at_least(0.0)},
    NamedRequirement{"homes-5.4.3", "with the mask minus without", "false", at_most(0.0)},
    NamedRequirement{"section-5.4.3", "the run", "images", at_least(1821.0)},
    NamedRequirement{"section-5.4.3", "with the mask", "overlap", at_least(0.85)},
    NamedRequirement{"section-5.4.3", "brown ball", "tracked", at_most(0.0)},
    // Chapter 6.
    NamedRequirement{"figure-6.7", "face, face colour and shirt", "identify", at_most(7.0)},
    NamedRequirement{"figure-6.7", "face, face colour and shirt", "identify, worst", at_most(12.0)},
    NamedRequirement{"figure-6.7", "face, face colour and shirt", "recognition beside the frame path, worst second",
                     at_most(8.0)},
    NamedRequirement{"figure-6.7", "face, face colour and shirt, a stranger", "identify, worst", at_most(12.0)},
    NamedRequirement{"figure-6.7", "face, face colour and shirt, a stranger",
                     "recognition beside the frame path, worst second", at_most(8.0)},
    NamedRequirement{"figure-6.8", "face, face colour and shirt", "identified where visible", at_least(1.0)},
    NamedRequirement{"figure-6.8", "face, face colour and shirt", "somebody identified where nobody is", at_most(0.0)},
    NamedRequirement{"figure-6.8", "face and shirt", "identified where visible", at_least(1.0)},
    NamedRequirement{"figure-6.8", "face and shirt", "somebody identified where nobody is", at_most(0.0)},
    NamedRequirement{"figure-6.8", "face alone", "identified where the face is turned away", at_most(0.05)},
    NamedRequirement{"people-cases", "shirts exchanged", "identified", at_least(0.85)},
    NamedRequirement{"people-cases", "shirts exchanged", "taken for somebody else", at_most(0.01)},
    NamedRequirement{"people-cases", "white shirt before a white wall", "identified", at_least(0.6)},
    NamedRequirement{"people-cases", "white shirt before a white wall", "taken for somebody else", at_most(0.01)},
    NamedRequirement{"people-cases", "light changed by two", "identified", at_least(0.85)},
    NamedRequirement{"people-cases", "light changed by two", "taken for somebody else", at_most(0.01)},
    NamedRequirement{"people-cases", "two people cross", "identified", at_least(0.85)},
    NamedRequirement{"people-cases", "two people cross", "taken for somebody else", at_most(0.01)},
    NamedRequirement{"people-cases", "dark face in dim light", "identified", at_least(0.85)},
    NamedRequirement{"people-cases", "dark face in dim light", "taken for somebody else", at_most(0.01)},
    NamedRequirement{"people-cases", "dark face in the dark, fill light", "identified", at_least(0.85)},
    NamedRequirement{"people-cases", "dark face in the dark, fill light", "taken for somebody else", at_most(0.01)},
    NamedRequirement{"people-cases", "dark face in the dark, no fill light", "taken for somebody else", at_most(0.01)},
    NamedRequirement{"people-cases", "dark face in a tenth of the light, no fill light", "taken for somebody else",
                     at_most(0.01)},
    NamedRequirement{"finals", "all of it", "right", at_least(0.95),
                     "a stranger's face that is near the threshold is never surely a stranger's"},
    NamedRequirement{"who-is-who", "in a line", "right of five", at_least(4.8), kFaces},
    NamedRequirement{"who-is-who", "in a line", "stranger named as a known person", at_most(0.04)},
    NamedRequirement{"who-is-who", "in a line", "known person called a stranger", at_most(0.04), kFaces},
    NamedRequirement{"who-is-who-home", "spread through the home", "at least four of five right", at_least(1.0)},
    NamedRequirement{"everything", "everything at once", "image, with probes and recognition", at_most(22.0)},
    NamedRequirement{"everything", "everything at once", "frame path, with probes, worst", at_most(33.0)},
    NamedRequirement{"everything", "everything at once", "stages whose worst run exceeds their budget at 1 GHz",
                     at_most(0.0)},
    NamedRequirement{"faces-caltech", "caltech / ours", "accepted and right", at_least(0.95)},
    NamedRequirement{"faces-caltech", "caltech / ours", "false acceptance, leave one out", at_most(0.03)},
    NamedRequirement{"faces-caltech", "caltech / ours", "accepted with a single image", at_most(0.0)},
    NamedRequirement{"people-human3", "human3 / ours, magnified", "IoU with the person's box", at_least(0.4)},
};

}  // namespace

std::span<const NamedRequirement> requirements() {
  return kRequirements;
}

std::string_view unmet_because(std::string_view table, std::string_view row, std::string_view quantity) {
  const auto is_it = [&](const NamedRequirement& one) {
    return one.table == table && one.row == row && one.quantity == quantity;
  };
  const auto* const found = std::ranges::find_if(kRequirements, is_it);
  return found == kRequirements.end() ? std::string_view{} : found->unmet_because;
}

std::vector<NamedRequirement> requirements_of(std::string_view table) {
  std::vector<NamedRequirement> all;
  std::ranges::copy_if(kRequirements, std::back_inserter(all),
                       [&](const NamedRequirement& required) { return required.table == table; });
  return all;
}

}  // namespace cgsr::lab
