// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// palmar-cad VERB FOLDER: does what FOLDER/request.json asks for with OpenCASCADE and leaves
// FOLDER/reply.json, or FOLDER/error.json and Palmar's exit code. Started by Palmar
// (records/product/cad_worker.h), not by people: OpenCASCADE may crash or never end on hostile
// files.
#include <unistd.h>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>

#include <cstdio>
#include <map>
#include <new>
#include <string>

#include "../worker/worker_main.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/worker.h"
#include "verbs.h"

namespace {

/// The verb, with errors of OpenCASCADE as Palmar's.
palmar::worker::Verb named_failures(const palmar::worker::Verb& verb) {
  return [verb](const palmar::worker::Json& request, const std::filesystem::path& folder,
                const palmar::Progress& progress) {
    try {
      return verb(request, folder, progress);
    } catch (const Standard_OutOfMemory&) {
      ::_exit(palmar::formats::kWorkerOutOfMemory);
    } catch (const Standard_Failure& failure) {
      const char* const text = failure.GetMessageString();
      throw palmar::NumericalError(
          std::string("OpenCASCADE gave up: ") + failure.DynamicType()->Name() +
          (text != nullptr && *text != '\0' ? std::string(", ") + text : ""));
    }
  };
}

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, palmar::worker::Verb> verbs = {
      {"check", palmar::cad_worker::check},       {"convert", palmar::cad_worker::convert},
      {"features", palmar::cad_worker::features}, {"handle", palmar::cad_worker::handle},
      {"import", palmar::cad_worker::import},     {"make", palmar::cad_worker::make},
      {"region", palmar::cad_worker::region},     {"version", palmar::cad_worker::version}};
  if (argc != 3 || verbs.count(argv[1]) == 0) {
    std::fprintf(stderr, "palmar-cad is started by palmar; see `palmar product -h`\n");
    return 2;
  }
  Message::DefaultMessenger()->ChangePrinters().Clear();
  // In whatever thread it happens, and whoever would catch it: the parent says it by name.
  std::set_new_handler([] { ::_exit(palmar::formats::kWorkerOutOfMemory); });
  return palmar::worker::answer(argv[2], named_failures(verbs.at(argv[1])));
}
