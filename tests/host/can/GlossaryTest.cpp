#include "host/can/glossary.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <string>

#include "common/commands.hpp"
#include "common/frames.hpp"
#include "host/can/field_text.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/remedies.hpp"

using namespace strainfinger;
using namespace strainfinger::can;

TEST_GROUP(Glossary) {
  static Term only(const char* word) {
    const std::vector<Term> terms = termsNamed(word);
    LONGS_EQUAL(1, terms.size());
    return terms.front();
  }
  /// Every name of the list is a term with the list's comment; those without a remedy.
  static std::string withoutRemedy(std::span<const ValueName> names) {
    std::string none;
    for (const ValueName& name : names) {
      const std::vector<Term> terms = termsNamed(name.name);
      const auto term = std::ranges::find(terms, name.comment, &Term::meaning);
      CHECK_TEXT(term != terms.end(), name.name);
      if (term->remedy.empty()) none.append(name.name).append(" ");
    }
    return none;
  }
};

TEST(Glossary, HasEveryFrame) {
  STRCMP_EQUAL("frame 0x480 + node, every 1000 ms", only("INFO").kind.c_str());
  for (const auto& catalogue : {frameCatalogue(), commandCatalogue()})
    for (const FrameEntry& entry : catalogue)
      CHECK_TEXT(std::ranges::any_of(termsNamed(entry.spec.name),
                                     [&](const Term& term) { return term.meaning == entry.spec.comment; }),
                 entry.spec.name);
}

TEST(Glossary, SaysWhatToDoAboutWhateverIsWrong) {
  STRCMP_EQUAL("", withoutRemedy(kFingerFaultNames).c_str());
  STRCMP_EQUAL("contact simulated ", withoutRemedy(kFingerFlagNames).c_str());
  STRCMP_EQUAL("run ", withoutRemedy(kFingerStateNames).c_str());
  STRCMP_EQUAL("none ", withoutRemedy(kCrashNames).c_str());
  STRCMP_EQUAL("done done_touched ", withoutRemedy(kCommandStatusNames).c_str());
  STRCMP_EQUAL("unknown power_on pin software ", withoutRemedy(kResetCauseNames).c_str());
  STRCMP_EQUAL("", withoutRemedy(kCountNames).c_str());
  STRCMP_EQUAL("tare contact_rate keep node count raw load word restart ",
               withoutRemedy(kCommandNames).c_str());
}

TEST(Glossary, AFieldOfSeveralFramesIsOneTerm) {
  STRCMP_EQUAL("field [deg] in CONTACT, CONTACT2", only("angle_deg").kind.c_str());
  STRCMP_EQUAL("bit 3 of flags in CONTACT, FORCE, PATCH, CONTACT2, FORCE2", only("uncertain").kind.c_str());
}

TEST(Glossary, ANameMayBeOfSeveralThings) {
  LONGS_EQUAL(2, termsNamed("gauges").size());  // the frame and the fault
  STRCMP_EQUAL("GAUGES", termsNamed("gauges").front().name.c_str());
}

TEST(Glossary, NamesAreFoundHoweverTheyAreWritten) {
  for (const char* word : {"stale_zero", "Stale Zero", "STALE-ZERO"})
    STRCMP_EQUAL("stale_zero", only(word).name.c_str());
  CHECK_TRUE(termsNamed("").empty());
  CHECK_TRUE(termsNamed("stale").empty());
}

TEST(Glossary, FieldsAreFoundWithoutTheirUnitToo) {
  for (const auto& catalogue : {frameCatalogue(), commandCatalogue()})
    for (const FrameEntry& entry : catalogue)
      for (const FieldSpec& field : entry.fields)
        if (isShown(field)) CHECK_TEXT(!termsNamed(field.meaning.name).empty(), field.meaning.name);
  STRCMP_EQUAL("zero_rate_per_s", only("zero rate").name.c_str());
}

TEST(Glossary, AWordThatIsNoneIsNearToSome) {
  STRCMP_EQUAL("uncertain", namesLike("uncertian").front().c_str());
  STRCMP_EQUAL("saturated", namesLike("saturatd").front().c_str());
  CHECK_TRUE(namesLike("xylophone").empty());
  CHECK_TRUE(namesLike("q").empty());
  CHECK_TRUE(namesLike("").empty());
  CHECK_TRUE(namesLike("stat").size() <= 3);
}

TEST(Glossary, ARemedyNamesTheBusItIsFor) {
  STRCMP_CONTAINS("monitor --can can7` shows", onBus(remedyFor(CommandStatus::kBusy), "can7").c_str());
  STRCMP_EQUAL("a --can udp b --can udp", onBus("a --can BUS b --can BUS", "udp").c_str());
  STRCMP_EQUAL("", onBus("", "udp").c_str());
  STRCMP_EQUAL("a --can udp -n 2 b --can udp", forNode("a --can BUS -n N b --can BUS", "udp", 2).c_str());
}
