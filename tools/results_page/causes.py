"""Why a planner solves nothing of a suite: {(suite, planner): sentence}. Only what a look at runs has shown."""

CAUSES = {
}
