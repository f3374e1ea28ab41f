/* SPDX-FileCopyrightText: Ravenchart contributors */
/* SPDX-License-Identifier: Apache-2.0 */

/* The oven of docs/plants.md as a Functional Mock-up Unit: FMI 3.0, or 2.0 with -DFMI2. */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

enum { TEMPERATURE = 1, HEATER = 2, LOSS = 3, COUNT = 4, DOOR = 5 };

typedef struct {
   double temperature, loss;
   int64_t heater, count;
   bool door;
} Oven;

static void advance (Oven *oven, double step)
{
   double power = oven->heater == 1 ? 2000.0 : 0.0;
   double loss = oven->door ? 10 * oven->loss : oven->loss;
   oven->temperature += (power - loss * (oven->temperature - 20.0)) * step / 20.0;
   oven->count++;
}

static Oven *made (void)
{
   Oven *oven = calloc (1, sizeof (Oven));
   oven->temperature = 20.0;
   oven->loss = 4.0;
   return oven;
}

static int get_real (Oven *oven, const unsigned refs[], size_t n, double values[])
{
   for (size_t i = 0; i < n; i++)
      values[i] = refs[i] == LOSS ? oven->loss : oven->temperature;
   return 0;
}

static int set_real (Oven *oven, const unsigned refs[], size_t n, const double values[])
{
   for (size_t i = 0; i < n; i++) {
      if (refs[i] != LOSS) return 3;
      oven->loss = values[i];
   }
   return 0;
}

#ifdef FMI2
const char *fmi2GetVersion (void) { return "2.0"; }
const char *fmi2GetTypesPlatform (void) { return "default"; }
void *fmi2Instantiate (const char *name, int kind, const char *guid, const char *resources,
                       const void *callbacks, int visible, int logging) { return made (); }
void fmi2FreeInstance (void *oven) { free (oven); }
int fmi2SetupExperiment (void *oven, int has_tolerance, double tolerance, double start,
                         int has_stop, double stop) { return 0; }
int fmi2EnterInitializationMode (void *oven) { return 0; }
int fmi2ExitInitializationMode (void *oven) { return 0; }
int fmi2Terminate (void *oven) { return 0; }
int fmi2GetReal (void *o, const unsigned r[], size_t n, double v[]) { return get_real (o, r, n, v); }
int fmi2SetReal (void *o, const unsigned r[], size_t n, const double v[]) { return set_real (o, r, n, v); }
int fmi2GetInteger (void *o, const unsigned r[], size_t n, int v[])
{
   for (size_t i = 0; i < n; i++) v[i] = r[i] == HEATER ? ((Oven *) o)->heater : ((Oven *) o)->count;
   return 0;
}
int fmi2SetInteger (void *o, const unsigned r[], size_t n, const int v[])
{
   for (size_t i = 0; i < n; i++) ((Oven *) o)->heater = v[i];
   return 0;
}
int fmi2GetBoolean (void *o, const unsigned r[], size_t n, int v[]) { v[0] = ((Oven *) o)->door; return 0; }
int fmi2SetBoolean (void *o, const unsigned r[], size_t n, const int v[]) { ((Oven *) o)->door = v[0]; return 0; }
int fmi2DoStep (void *o, double at, double step, int no_set) { advance (o, step); return 0; }

/* Functions that every unit of FMI 2.0 must have, and that this one says no to. */
#define NONE(name) int fmi2##name (void) { return 3; }
NONE (CancelStep) NONE (CompletedIntegratorStep) NONE (DeSerializeFMUstate)
NONE (EnterContinuousTimeMode) NONE (EnterEventMode) NONE (FreeFMUstate)
NONE (GetBooleanStatus) NONE (GetContinuousStates) NONE (GetDerivatives)
NONE (GetDirectionalDerivative) NONE (GetEventIndicators) NONE (GetFMUstate)
NONE (GetIntegerStatus) NONE (GetNominalsOfContinuousStates) NONE (GetRealOutputDerivatives)
NONE (GetRealStatus) NONE (GetStatus) NONE (GetString) NONE (GetStringStatus)
NONE (NewDiscreteStates) NONE (Reset) NONE (SerializeFMUstate) NONE (SerializedFMUstateSize)
NONE (SetContinuousStates) NONE (SetDebugLogging) NONE (SetFMUstate)
NONE (SetRealInputDerivatives) NONE (SetString) NONE (SetTime)
#else
const char *fmi3GetVersion (void) { return "3.0"; }
void *fmi3InstantiateCoSimulation (const char *name, const char *token, const char *resources,
                                   bool visible, bool logging, bool events, bool early,
                                   const unsigned required[], size_t n, void *environment,
                                   void *log, void *intermediate) { return made (); }
void fmi3FreeInstance (void *oven) { free (oven); }
int fmi3EnterInitializationMode (void *o, bool has_tolerance, double tolerance, double start,
                                 bool has_stop, double stop) { return 0; }
int fmi3ExitInitializationMode (void *oven) { return 0; }
int fmi3Terminate (void *oven) { return 0; }
int fmi3GetFloat64 (void *o, const unsigned r[], size_t n, double v[], size_t m) { return get_real (o, r, n, v); }
int fmi3SetFloat64 (void *o, const unsigned r[], size_t n, const double v[], size_t m) { return set_real (o, r, n, v); }
int fmi3GetInt64 (void *o, const unsigned r[], size_t n, int64_t v[], size_t m)
{
   for (size_t i = 0; i < n; i++) v[i] = r[i] == HEATER ? ((Oven *) o)->heater : ((Oven *) o)->count;
   return 0;
}
int fmi3SetInt64 (void *o, const unsigned r[], size_t n, const int64_t v[], size_t m)
{
   for (size_t i = 0; i < n; i++) ((Oven *) o)->heater = v[i];
   return 0;
}
int fmi3GetBoolean (void *o, const unsigned r[], size_t n, bool v[], size_t m) { v[0] = ((Oven *) o)->door; return 0; }
int fmi3SetBoolean (void *o, const unsigned r[], size_t n, const bool v[], size_t m) { ((Oven *) o)->door = v[0]; return 0; }
int fmi3DoStep (void *o, double at, double step, bool no_set, bool *event, bool *terminate, bool *early, double *last)
{
   advance (o, step);
   *event = *terminate = *early = false;
   *last = at + step;
   return 0;
}

/* Functions that every unit of FMI 3.0 must have, and that this one says no to. */
#define NONE(name) int fmi3##name (void) { return 3; }
NONE (ActivateModelPartition) NONE (CompletedIntegratorStep) NONE (DeserializeFMUState)
NONE (EnterConfigurationMode) NONE (EnterContinuousTimeMode) NONE (EnterEventMode)
NONE (EnterStepMode) NONE (EvaluateDiscreteStates) NONE (ExitConfigurationMode)
NONE (FreeFMUState) NONE (GetAdjointDerivative) NONE (GetBinary) NONE (GetClock)
NONE (GetContinuousStateDerivatives) NONE (GetContinuousStates) NONE (GetDirectionalDerivative)
NONE (GetEventIndicators) NONE (GetFMUState) NONE (GetFloat32) NONE (GetInt16) NONE (GetInt32)
NONE (GetInt8) NONE (GetIntervalDecimal) NONE (GetIntervalFraction)
NONE (GetNominalsOfContinuousStates) NONE (GetNumberOfContinuousStates)
NONE (GetNumberOfEventIndicators) NONE (GetNumberOfVariableDependencies)
NONE (GetOutputDerivatives) NONE (GetShiftDecimal) NONE (GetShiftFraction) NONE (GetString)
NONE (GetUInt16) NONE (GetUInt32) NONE (GetUInt64) NONE (GetUInt8)
NONE (GetVariableDependencies) NONE (InstantiateModelExchange)
NONE (InstantiateScheduledExecution) NONE (Reset) NONE (SerializeFMUState)
NONE (SerializedFMUStateSize) NONE (SetBinary) NONE (SetClock) NONE (SetContinuousStates)
NONE (SetDebugLogging) NONE (SetFMUState) NONE (SetFloat32) NONE (SetInt16) NONE (SetInt32)
NONE (SetInt8) NONE (SetIntervalDecimal) NONE (SetIntervalFraction) NONE (SetShiftDecimal)
NONE (SetShiftFraction) NONE (SetString) NONE (SetTime) NONE (SetUInt16) NONE (SetUInt32)
NONE (SetUInt64) NONE (SetUInt8) NONE (UpdateDiscreteStates)
#endif
