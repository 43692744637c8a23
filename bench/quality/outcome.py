"""What a verb answered for one piece of material, beside the truth."""


def outcome(answer, wrong, truth, stated, interval):
    """`answer`: the verb's JSON or {"refused": ...}; `truth`, `stated`, `interval`: texts for the table."""
    if "refused" in answer:
        return {"quality": "refused", "wrong": False, "truth": truth, "stated": answer["refused"], "interval": "", "aspects": []}
    return {"quality": answer["quality"], "wrong": bool(wrong), "truth": truth, "stated": stated, "interval": interval,
            "aspects": sorted({w["aspect"] for w in answer["warnings"]})}


def inside(low, value, high):
    return low is not None and high is not None and low <= value <= high
