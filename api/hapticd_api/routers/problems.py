"""What each kind of problem means: the address in every error's `type` leads here."""

from __future__ import annotations

from dataclasses import asdict
from html import escape
from typing import Annotated

from fastapi import APIRouter, Header, Path
from pydantic import BaseModel
from starlette.responses import Response

from hapticd.problem import Problem
from hapticd.problem_types import PROBLEM_TYPES, ProblemType
from hapticd_api.problem_response import problem_answers

router = APIRouter(prefix="/problems", tags=["problems"])


class ProblemPage(BaseModel):
    """One kind of problem: why it happens, what to check, what cures it."""

    slug: str
    status: int
    title: str
    cause: str
    check: str
    fix: str
    retryable: bool


class ProblemIndex(BaseModel):
    """Every kind of problem."""

    problems: list[ProblemPage]


def _page(kind: ProblemType) -> ProblemPage:
    return ProblemPage(**asdict(kind))


@router.get("", operation_id="list_problems", summary="Every kind of problem")
async def list_problems() -> ProblemIndex:
    """Every kind of problem this API answers with."""
    return ProblemIndex(problems=[_page(kind) for kind in PROBLEM_TYPES.values()])


@router.get(
    "/{slug}",
    operation_id="get_problem",
    summary="One kind of problem",
    response_model=ProblemPage,
    responses={
        200: {"content": {"text/html": {"schema": {"type": "string"}}}},
        **problem_answers("route-not-found"),
    },
)
async def get_problem(
    slug: Annotated[str, Path(examples=["unknown-field"])], accept: Annotated[str, Header()] = "*/*"
) -> Response:
    """Cause, check and cure; as a page where HTML is asked for, as JSON otherwise."""
    kind = PROBLEM_TYPES.get(slug)
    if kind is None:
        raise Problem(
            "route-not-found", f"There is no problem called {slug!r}.", hint="GET /problems lists them."
        )
    if "text/html" in accept:
        return Response(_html(kind), media_type="text/html", headers={"Vary": "Accept"})
    return Response(_page(kind).model_dump_json(), media_type="application/json", headers={"Vary": "Accept"})


def _html(kind: ProblemType) -> str:
    title = escape(kind.title)
    parts = (("Why it happens", kind.cause), ("What to check", kind.check), ("What cures it", kind.fix))
    body = "".join(f"<h2>{heading}</h2><p>{escape(text)}</p>" for heading, text in parts)
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title} · hapticd</title>
<link rel="icon" href="/page/icon.svg" type="image/svg+xml">
<link rel="stylesheet" href="/page/style.css">
</head>
<body class="prose">
<main>
<p class="quiet">{kind.status} · {escape(kind.slug)}</p>
<h1>{title}</h1>
{body}
<p><a href="/">hapticd</a> · <a href="/docs">the API</a></p>
</main>
</body>
</html>
"""
