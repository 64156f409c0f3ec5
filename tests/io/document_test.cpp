#include "io/document.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

namespace tsubu::io {
namespace {

Document parsed(const std::string& text) { return Document::fromText(text, "file.toml"); }

std::string at(const Value* value) { return value ? toString(value->position()) : "nothing"; }

TEST(Document, EveryValueKnowsWhereItIs) {
  const Document document = parsed("title = \"x\"\n\n[a]\nb = 3\n  c = [1,\n 2.5, \"three\"]\nd.e = true\n[a.f]\ng = { h = 1 }\n");
  const Value& root = document.root();
  EXPECT_EQ(at(root.find("title")), "file.toml:1:9");
  const Value* a = root.find("a");
  EXPECT_EQ(toString(a->keyPosition()), "file.toml:3:2");
  EXPECT_EQ(at(a->find("b")), "file.toml:4:5");
  EXPECT_EQ(toString(a->find("b")->keyPosition()), "file.toml:4:1");
  const Value* c = a->find("c");
  ASSERT_TRUE(c && c->array());
  EXPECT_EQ(at(&(*c->array())[2]), "file.toml:6:7");
  EXPECT_EQ((*c->array())[2].path(), "a.c.2");
  EXPECT_EQ(at(a->find("d")->find("e")), "file.toml:7:7");
  EXPECT_EQ(a->find("f")->find("g")->find("h")->path(), "a.f.g.h");
}

TEST(Document, KindsOfValues) {
  const Document document = parsed("b = true\ni = 3\nr = 2.5\nt = \"x\"\nd = 1979-05-27\na = []\no = {}\n");
  const Value& root = document.root();
  EXPECT_EQ(*root.find("b")->boolean(), true);
  EXPECT_EQ(*root.find("i")->integer(), 3);
  EXPECT_EQ(root.find("i")->real(), nullptr);
  EXPECT_EQ(*root.find("r")->real(), 2.5);
  EXPECT_EQ(*root.find("t")->text(), "x");
  EXPECT_NE(root.find("a")->array(), nullptr);
  EXPECT_NE(root.find("o")->table(), nullptr);
  EXPECT_EQ(root.find("none"), nullptr);
  const std::pair<const char*, const char*> descriptions[] = {
      {"b", "true"},           {"i", "the number 3"}, {"r", "the number 2.5"}, {"t", "the text 'x'"}, {"d", "the date or time 1979-05-27"},
      {"a", "an empty array"}, {"o", "a table"}};
  for (const auto& [key, text] : descriptions) EXPECT_EQ(root.find(key)->description(), text);
}

TEST(Document, LongTextsAreCutBetweenCharacters) {
  std::string text = "x";
  for (int i = 0; i < 40; ++i) text += "ö";
  const Document document = parsed("t = \"" + text + "\"");
  EXPECT_EQ(document.root().find("t")->description(), "the text '" + text.substr(0, 37) + "…'");
}

TEST(Document, MembersKeepTheOrderOfTheFile) {
  const Document document = parsed("[z]\n[a]\n[m]\n");
  std::string order;
  for (const auto& [key, value] : *document.root().table()) order += key;
  EXPECT_EQ(order, "zam");
}

TEST(Document, SyntaxErrorsHaveAPlace) {
  for (const auto& [text, place] : {std::pair("a = \nb = 2\n", "file.toml:1:"), std::pair("a = 1\nb = [1, 2\n", "file.toml:2:"),
                                    std::pair("a = 1\na = 2\n", "file.toml:2:"), std::pair("x = \"\xff\"\n", "file.toml:1:")}) {
    try {
      parsed(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::scene);
      EXPECT_EQ(std::string(error.what()).substr(0, std::string(place).size()), place) << error.what();
    }
  }
}

// A hundred thousand tables in each other would end the stack.
TEST(Document, KeysOfFarTooManyPartsAreRefused) {
  std::string key = "a";
  for (int i = 0; i < 100000; ++i) key += ".a";
  for (const std::string& text : {key + " = 1", "x = 1\n[" + key + "]\n", "x = {" + key + " = 1}"}) EXPECT_THROW(parsed(text), Error);
  Document document = parsed("a = 1");
  EXPECT_THROW(document.set(key + "=1"), Error);
  EXPECT_THROW(document.set("b={" + key + "=1}"), Error);
}

TEST(Document, DotsThatAreNoKeysDoNotCount) {
  std::string numbers = "[0.5", dots(500, '.');
  for (int i = 0; i < 500; ++i) numbers += ", 1.5";
  EXPECT_NO_THROW(parsed("x = " + numbers + "]\nt = \"\\\"" + dots + "\" # " + dots + "\nu = '" + dots + "'\n"));
}

TEST(Document, WhatNobodyReadIsAnError) {
  const Document document = parsed("good = 1\ngod = 2\n[a]\nb = 1\nspeeed = 2\n[unread]\nx = 1\n");
  document.root().find("good");
  document.root().find("a")->find("b");
  document.root().find("a")->know("speed");
  const auto complaints = document.unreadKeys();
  ASSERT_EQ(complaints.size(), 3u);
  std::vector<std::string> texts;
  for (const Diagnostic& d : complaints) texts.push_back(toString(d));
  EXPECT_NE(std::find(texts.begin(), texts.end(), "file.toml:2:1: Unknown key 'god'. (did you mean 'good'?)"), texts.end());
  EXPECT_NE(std::find(texts.begin(), texts.end(), "file.toml:5:1: Unknown key 'speeed' in 'a'. (did you mean 'speed'?)"), texts.end());
  EXPECT_NE(std::find(texts.begin(), texts.end(), "file.toml:6:2: Unknown key 'unread'. (known here: good or a)"), texts.end());
}

TEST(Document, SkippedTablesAreNotSearched) {
  const Document document = parsed("[a]\nb = 1\n");
  document.root().find("a")->skip();
  EXPECT_TRUE(document.unreadKeys().empty());
}

TEST(Document, OverridesReplaceMakeAndFindByName) {
  Document document = parsed("[a]\nb = 1\n[[list]]\nname = \"first\"\nx = 1\n[[list]]\nname = \"second\"\nx = 2\n");
  document.set("a.b=2");
  document.set("a.c = [1, 2]");
  document.set("a.d=2 mm");
  document.set("a.e=\"x = y\"");
  document.set("list.second.x=20");
  document.set("list.0.x=10");
  document.set("new.table.\"with blank\"=true");
  const Value& root = document.root();
  EXPECT_EQ(*root.find("a")->find("b")->integer(), 2);
  EXPECT_EQ(at(root.find("a")->find("b")), "--set a.b");
  EXPECT_EQ(root.find("a")->find("c")->array()->size(), 2u);
  EXPECT_EQ(*root.find("a")->find("d")->text(), "2 mm");
  EXPECT_EQ(*root.find("a")->find("e")->text(), "x = y");
  EXPECT_EQ(*(*root.find("list")->array())[1].find("x")->integer(), 20);
  EXPECT_EQ(*(*root.find("list")->array())[0].find("x")->integer(), 10);
  EXPECT_TRUE(*root.find("new")->find("table")->find("with blank")->boolean());
  EXPECT_TRUE(root.find("new")->madeByOverride());
  EXPECT_FALSE(root.find("a")->madeByOverride());
}

// A value cannot smuggle in other keys.
TEST(Document, AnOverrideIsOneValue) {
  Document document = parsed("a = 1\n");
  document.set("a=1\nb = 2");
  EXPECT_NE(document.root().find("a")->text(), nullptr);
  EXPECT_EQ(document.root().find("b"), nullptr);
}

TEST(Document, OverridesThatLeadNowhere) {
  for (const char* bad : {"a.b.c=1", "list.5=1", "list.name=1", "nothing", "a..b=1", ".a=1", "a.=1", "=1", "\"a=1"}) {
    Document document = parsed("a = {b = 1}\nlist = [1]\n");
    EXPECT_THROW(document.set(bad), Error) << bad;
  }
}

TEST(Document, Files) {
  const std::string path = testing::TempDir() + "tsubu_document_test.toml";
  std::ofstream(path) << "a = 1\n";
  EXPECT_EQ(*Document::fromFile(path).root().find("a")->integer(), 1);
  std::ofstream(path, std::ios::trunc).close();
  EXPECT_TRUE(Document::fromFile(path).root().table()->empty());
  std::remove(path.c_str());
  try {
    Document::fromFile(path);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::files);
    EXPECT_EQ(error.diagnostics()[0].message, "The scene file '" + path + "' cannot be read.");
  }
}

}  // namespace
}  // namespace tsubu::io
