// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/balance_section.h"

#include <numbers>

#include "palmar/report/page/html_text.h"
#include "palmar/report/page/plain_words.h"

namespace palmar {
namespace {

std::string left_as_closed(const ContactResult& contact) {
  return "<p>The forces of the skin on the product add up to " +
         short_number(contact.total.force_vector.norm()) + " N as a vector, against " +
         short_number(contact.total.force) +
         " N as a sum of amounts: what is left over is not balanced by this grasp alone.</p>\n";
}

}  // namespace

std::string balance_section(const Assessment& assessment) {
  const Balance& balance = assessment.balance;
  if (balance.status == BalanceStatus::kOff) return left_as_closed(assessment.contact);
  const bool is_good = balance.status == BalanceStatus::kBalanced;
  std::string html = "<p class=\"note " + std::string(is_good ? "good" : "fair") + "\"><strong>" +
                     (is_good                                      ? "At rest."
                      : balance.status == BalanceStatus::kSlipsOut ? "Slips out of the hand."
                                                                   : "Not at rest.") +
                     "</strong> " + html_escaped(capitalised(balance.message)) + ".";
  if (is_good) {
    html += " The product moved by " + short_number(balance.moved, 2) + " mm and turned by " +
            short_number(balance.turned * 180.0 / std::numbers::pi, 2) +
            "° in the hand since it was closed; " + short_number(100.0 * balance.friction_use, 2) +
            " % of the friction (coefficient " + short_number(balance.friction, 2) + ") is in use.";
    if (balance.strength_use) {
      html += " The fingers' joints give " + short_number(100.0 * *balance.strength_use, 2) +
              " % of the moments that people reach.";
    }
  }
  html += "</p>\n";
  if (balance.status == BalanceStatus::kSlipsOut) {
    html += "<p>What follows shows the hand as it was closed, out of balance.</p>\n" +
            left_as_closed(assessment.contact);
  }
  return html;
}

}  // namespace palmar
